// RUN: rtsl-opt %s --rtsl-insert-suspends --rtsl-tail-traces | FileCheck %s
// RUN: rtsl-opt %s --rtsl-split="no-dispatch report=text" 2>&1 >/dev/null | FileCheck %s --check-prefix=REPORT

// What the ray brings back is what this one brings back: it takes its place, through branches too.
// CHECK-LABEL: func.func @plain
// CHECK:         rtsl.spawn %{{.*}}, %{{.*}} last
// CHECK-NEXT:    return {rtsl.last}
// CHECK-NOT:     trace_result
// REPORT-LABEL: plain: 1 state, frame of 0 bytes
// REPORT-NEXT:    trace at {{.*}}, a tail trace: its ray replaces this one, so recursion runs as a loop
func.func @plain(%self: !rtsl.ref<"M">) {
  %p = rtsl.state "HitPoint" : !rtsl.ptr<vector<3xf32>>
  %o = rtsl.load %p : !rtsl.ptr<vector<3xf32>>
  %color = rtsl.state "SampleColor" : !rtsl.ptr<vector<3xf32>>
  %c = rtsl.trace %o, %o : vector<3xf32>
  cf.br ^end(%c : vector<3xf32>)
^end(%v: vector<3xf32>):
  rtsl.store %v, %color : !rtsl.ptr<vector<3xf32>>
  return
}

// Products would be rounded in another order in front of the trace: this one waits, and keeps its factor.
// CHECK-LABEL: func.func @product
// CHECK:         rtsl.suspend
// REPORT-LABEL: product: 2 states
// REPORT:         saved          4 bytes
// REPORT:         then           only sums and products
func.func @product(%self: !rtsl.ref<"M">) {
  %p = rtsl.state "HitPoint" : !rtsl.ptr<vector<3xf32>>
  %o = rtsl.load %p : !rtsl.ptr<vector<3xf32>>
  %w = rtsl.rand
  %color = rtsl.state "SampleColor" : !rtsl.ptr<vector<3xf32>>
  %c = rtsl.trace %o, %o : vector<3xf32>
  %f = vector.broadcast %w : f32 to vector<3xf32>
  %v = arith.mulf %c, %f : vector<3xf32>
  rtsl.store %v, %color : !rtsl.ptr<vector<3xf32>>
  return
}

// Something happens after it.
// CHECK-LABEL: func.func @draws
// CHECK:         rtsl.suspend
// REPORT-LABEL: draws: 2 states
// REPORT-NOT:     then
func.func @draws(%self: !rtsl.ref<"M">) {
  %p = rtsl.state "HitPoint" : !rtsl.ptr<vector<3xf32>>
  %o = rtsl.load %p : !rtsl.ptr<vector<3xf32>>
  %color = rtsl.state "SampleColor" : !rtsl.ptr<vector<3xf32>>
  %c = rtsl.trace %o, %o : vector<3xf32>
  %w = rtsl.rand
  %d = vector.broadcast %w : f32 to vector<3xf32>
  rtsl.store %d, %color : !rtsl.ptr<vector<3xf32>>
  return
}

// A payload that was given is handed on: no copy, no frame.
// CHECK-LABEL: func.func @passes
// CHECK-NOT:     rtsl.var
// CHECK:         rtsl.rand
// CHECK-NEXT:    %[[OWN:.*]] = rtsl.payload
// CHECK:         %[[Y:.*]] = rtsl.field %[[OWN]]["y"]
// CHECK-NEXT:    rtsl.store %{{.*}}, %[[Y]]
// CHECK:         rtsl.spawn_payload {{.*}} carries %[[OWN]] last
// CHECK-NEXT:    return {rtsl.last}
// REPORT-LABEL: passes: 1 state, frame of 0 bytes
func.func @passes(%self: !rtsl.ref<"M">) {
  %p = rtsl.state "HitPoint" : !rtsl.ptr<vector<3xf32>>
  %o = rtsl.load %p : !rtsl.ptr<vector<3xf32>>
  %near = arith.constant 0.0 : f32
  %own = rtsl.payload : !rtsl.ptr<!rtsl.struct<"P", {x: f32, y: f32}>>
  %ox = rtsl.field %own["x"] : !rtsl.ptr<!rtsl.struct<"P", {x: f32, y: f32}>> -> !rtsl.ptr<f32>
  %oy = rtsl.field %own["y"] : !rtsl.ptr<!rtsl.struct<"P", {x: f32, y: f32}>> -> !rtsl.ptr<f32>
  %q = rtsl.var "payload" : !rtsl.ptr<!rtsl.struct<"P", {x: f32, y: f32}>>
  %qx = rtsl.field %q["x"] : !rtsl.ptr<!rtsl.struct<"P", {x: f32, y: f32}>> -> !rtsl.ptr<f32>
  %qy = rtsl.field %q["y"] : !rtsl.ptr<!rtsl.struct<"P", {x: f32, y: f32}>> -> !rtsl.ptr<f32>
  %x = rtsl.load %ox : !rtsl.ptr<f32>
  rtsl.store %x, %qx : !rtsl.ptr<f32>
  %r = rtsl.rand
  rtsl.store %r, %qy : !rtsl.ptr<f32>
  rtsl.trace_payload %o, %o from %near to %r carries %q : !rtsl.ptr<!rtsl.struct<"P", {x: f32, y: f32}>>
  %a = rtsl.load %qx : !rtsl.ptr<f32>
  rtsl.store %a, %ox : !rtsl.ptr<f32>
  %b = rtsl.load %qy : !rtsl.ptr<f32>
  rtsl.store %b, %oy : !rtsl.ptr<f32>
  return
}

// Only part of it is returned: it needs a copy.
// CHECK-LABEL: func.func @keeps
// CHECK:         rtsl.var "payload"
// CHECK:         rtsl.suspend
// REPORT-LABEL: keeps: 2 states, frame of 8 bytes
func.func @keeps(%self: !rtsl.ref<"M">) {
  %p = rtsl.state "HitPoint" : !rtsl.ptr<vector<3xf32>>
  %o = rtsl.load %p : !rtsl.ptr<vector<3xf32>>
  %near = arith.constant 0.0 : f32
  %own = rtsl.payload : !rtsl.ptr<!rtsl.struct<"P", {x: f32, y: f32}>>
  %ox = rtsl.field %own["x"] : !rtsl.ptr<!rtsl.struct<"P", {x: f32, y: f32}>> -> !rtsl.ptr<f32>
  %q = rtsl.var "payload" : !rtsl.ptr<!rtsl.struct<"P", {x: f32, y: f32}>>
  %qx = rtsl.field %q["x"] : !rtsl.ptr<!rtsl.struct<"P", {x: f32, y: f32}>> -> !rtsl.ptr<f32>
  %qy = rtsl.field %q["y"] : !rtsl.ptr<!rtsl.struct<"P", {x: f32, y: f32}>> -> !rtsl.ptr<f32>
  %x = rtsl.load %ox : !rtsl.ptr<f32>
  rtsl.store %x, %qx : !rtsl.ptr<f32>
  rtsl.store %x, %qy : !rtsl.ptr<f32>
  rtsl.trace_payload %o, %o from %near to %x carries %q : !rtsl.ptr<!rtsl.struct<"P", {x: f32, y: f32}>>
  %a = rtsl.load %qx : !rtsl.ptr<f32>
  rtsl.store %a, %ox : !rtsl.ptr<f32>
  return
}

// MUTATION tail-traces of suspend/TailTraces.cpp: what is left in SampleColor is not looked at
// - return hasOnePath && color == result.getResult();
// + return hasOnePath && color;
