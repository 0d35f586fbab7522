// RUN: rtsl-opt %s --rtsl-insert-suspends | FileCheck %s --check-prefix=SUSPEND
// RUN: rtsl-opt %s --rtsl-split="no-dispatch" | FileCheck %s --check-prefix=SPLIT

// A ray with a payload is prepared before the suspend; its payload lies in the frame, where the ray's programs read and
// write it. What else is alive is saved beside it, but for what this ray was given itself: that is where it was.

// SUSPEND-LABEL: func.func @f
// SUSPEND:         %[[P:.*]] = rtsl.var "payload"
// SUSPEND:         rtsl.spawn_payload %{{.*}}, %{{.*}} from %{{.*}} to %{{.*}} carries %[[P]] mask %{{.*}} {how = 1 : i32, ray_type = 2 : i32}
// SUSPEND-NEXT:    rtsl.suspend ^[[RESUME:.*]]
// SUSPEND-NEXT:  ^[[RESUME]]:
// SUSPEND-NEXT:    rtsl.trace_returned

// SPLIT-LABEL: func.func private @f.state0(%arg0: !rtsl.ref<"M">) -> i32
// SPLIT:         %[[P:.*]] = rtsl.frame_object "payload"[{{[0-9]+}}] : !rtsl.ptr<!rtsl.struct<"P"
// SPLIT:         rtsl.spawn_payload {{.*}} carries %[[P]]
// SPLIT-NOT:     rtsl.spawn %
// SPLIT:         rtsl.frame_store %{{.*}}, "r"
// SPLIT-NOT:     rtsl.frame_store
// SPLIT:         rtsl.next trace @f.state1
// SPLIT-LABEL: func.func private @f.state1(%arg0: !rtsl.ref<"M">) -> i32
// SPLIT:         rtsl.trace_returned
// SPLIT-DAG:     rtsl.frame_object "payload"
// SPLIT-DAG:     rtsl.frame_load "r"
// SPLIT-DAG:     rtsl.payload : !rtsl.ptr<!rtsl.struct<"Q"
// SPLIT:         rtsl.store %{{.*}}, %{{.*}} : !rtsl.ptr<f32>
// SPLIT:         rtsl.next done
func.func @f(%self: !rtsl.ref<"M">) {
  %a = rtsl.state "HitPoint" : !rtsl.ptr<vector<3xf32>>
  %o = rtsl.load %a : !rtsl.ptr<vector<3xf32>>
  %r = rtsl.rand loc("r")
  %zero = arith.constant 0.0 : f32
  %mask = arith.constant 7 : i32
  %q0 = rtsl.payload : !rtsl.ptr<!rtsl.struct<"Q", {light: f32}>>
  %l0 = rtsl.field %q0["light"] : !rtsl.ptr<!rtsl.struct<"Q", {light: f32}>> -> !rtsl.ptr<f32>
  %given = rtsl.load %l0 : !rtsl.ptr<f32>
  %p = rtsl.var "payload" : !rtsl.ptr<!rtsl.struct<"P", {x: f32, y: f32}>>
  %x = rtsl.field %p["x"] : !rtsl.ptr<!rtsl.struct<"P", {x: f32, y: f32}>> -> !rtsl.ptr<f32>
  rtsl.store %r, %x : !rtsl.ptr<f32>
  rtsl.trace_payload %o, %o from %zero to %r carries %p mask %mask {ray_type = 2 : i32, how = 1 : i32} : !rtsl.ptr<!rtsl.struct<"P", {x: f32, y: f32}>>
  %y = rtsl.field %p["y"] : !rtsl.ptr<!rtsl.struct<"P", {x: f32, y: f32}>> -> !rtsl.ptr<f32>
  %v = rtsl.load %y : !rtsl.ptr<f32>
  %s = arith.addf %v, %r : f32
  %w = arith.addf %s, %given : f32
  %q = rtsl.payload : !rtsl.ptr<!rtsl.struct<"Q", {light: f32}>>
  %l = rtsl.field %q["light"] : !rtsl.ptr<!rtsl.struct<"Q", {light: f32}>> -> !rtsl.ptr<f32>
  rtsl.store %w, %l : !rtsl.ptr<f32>
  return
}

// MUTATION ray-graph of states/RayGraph.cpp: a tail trace counts as one that is waited for
// - (isLast ? sentLast : sent) |= 1u << kind;
// + sent |= 1u << kind;
