// A ray within the loop over lights. Only the position in the loop and the sum are saved across it: the number of lights and
// the point are rematerialised, and what the light wrote is the ray's own state, which other rays do not change. The shadow ray
// of `rtsl.illuminate` is not a suspend, because nothing that it meets is shaded.
// RUN: rtsl-opt %s --rtsl-ssa --rtsl-split=no-dispatch | FileCheck %s
// RUN: rtsl-opt %s --rtsl-ssa --rtsl-split="no-dispatch report=text" 2>&1 >/dev/null | FileCheck %s --check-prefix=REPORT

rtsl.class @Lit root "rt_Material" {}

func.func @rtsl_rt_Light_illumination(%light: !rtsl.ref<"object">) attributes {rtsl.export, rtsl.slot = "rt_Light.illumination"} {
  rtsl.return
}
func.func @Lit.shade(%self: !rtsl.ref<"Lit">) attributes {rtsl.class = "Lit", rtsl.method = "shade", rtsl.export} {
  %zero = arith.constant dense<0.0> : vector<3xf32>
  %sum = rtsl.var "sum" : !rtsl.ptr<vector<3xf32>>
  rtsl.store %zero, %sum : !rtsl.ptr<vector<3xf32>>
  %place = rtsl.state "HitPoint" : !rtsl.ptr<vector<3xf32>>
  %p = rtsl.load %place : !rtsl.ptr<vector<3xf32>>
  %light = rtsl.state "LightColor" : !rtsl.ptr<vector<3xf32>>
  rtsl.illuminance %p {
    %c = rtsl.trace %p, %p : vector<3xf32>
    %l = rtsl.load %light : !rtsl.ptr<vector<3xf32>>
    %lit = arith.mulf %c, %l : vector<3xf32>
    %s = rtsl.load %sum : !rtsl.ptr<vector<3xf32>>
    %t = arith.addf %s, %lit : vector<3xf32>
    rtsl.store %t, %sum : !rtsl.ptr<vector<3xf32>>
    rtsl.yield
  }
  %all = rtsl.load %sum : !rtsl.ptr<vector<3xf32>>
  %color = rtsl.state "SampleColor" : !rtsl.ptr<vector<3xf32>>
  rtsl.store %all, %color : !rtsl.ptr<vector<3xf32>>
  rtsl.return
}

// CHECK-LABEL: func.func private @Lit.shade.state1
// CHECK-DAG:     %[[C:.*]] = rtsl.trace_result
// CHECK-DAG:     %[[SUM:.*]] = rtsl.frame_load "sum"
// CHECK-DAG:     %[[I:.*]] = rtsl.frame_load "lightIndex"
// CHECK:         %[[PLACE:.*]] = rtsl.state "LightColor"
// CHECK:         %[[L:.*]] = rtsl.load %[[PLACE]]
// CHECK:         %[[LIT:.*]] = arith.mulf %[[C]], %[[L]]
// CHECK:         %[[MORE:.*]] = arith.addf %[[SUM]], %[[LIT]]
// CHECK:         rtsl.illuminate
// CHECK-DAG:     rtsl.frame_store %{{.*}}, "lightIndex"
// CHECK-DAG:     rtsl.frame_store %[[MORE]], "sum"
// CHECK:         rtsl.spawn
// CHECK:         rtsl.next trace @Lit.shade.state1

// REPORT: Lit.shade: 2 states, frame of 16 bytes
// REPORT: saved          16 bytes: lightIndex, sum
