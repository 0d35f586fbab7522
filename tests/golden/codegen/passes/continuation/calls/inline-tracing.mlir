// RUN: rtsl-opt %s --rtsl-inline-tracing --split-input-file | FileCheck %s

// A helper that traces is inlined into its callers, and removed if it has no other callers.
// CHECK-LABEL: func.func @caller
// CHECK-NEXT:   cf.br ^bb1(%arg0 : vector<3xf32>)
// CHECK-NEXT: ^bb1(%[[D:.*]]: vector<3xf32>):
// CHECK-NEXT:   %[[C:.*]] = rtsl.trace %[[D]], %[[D]]
// CHECK-NEXT:   cf.br ^bb2(%[[C]] : vector<3xf32>)
// CHECK-NEXT: ^bb2(%[[R:.*]]: vector<3xf32>):
// CHECK-NEXT:   arith.addf %[[R]], %arg0
// CHECK-NOT:  @helper
func.func @caller(%d: vector<3xf32>) {
  %c = call @helper(%d) : (vector<3xf32>) -> vector<3xf32>
  %s = arith.addf %c, %d : vector<3xf32>
  return
}
func.func private @helper(%d: vector<3xf32>) -> vector<3xf32> {
  %c = rtsl.trace %d, %d : vector<3xf32>
  return %c : vector<3xf32>
}

// -----

// An entry only hands on its object: that is a jump to the method's first state.
// CHECK-LABEL: func.func @entry
// CHECK:        call @A.shade({{.*}}) {rtsl.tail}
// CHECK:      func.func private @A.shade
func.func @entry(%o: !rtsl.ref<"rt_Material">, %p: i1) {
  cf.cond_br %p, ^call, ^end
^call:
  %a = rtsl.cast_ref %o : !rtsl.ref<"rt_Material"> -> !rtsl.ref<"A">
  call @A.shade(%a) : (!rtsl.ref<"A">) -> ()
  cf.br ^end
^end:
  return
}
func.func private @A.shade(%self: !rtsl.ref<"A">) {
  %p = rtsl.state "HitPoint" : !rtsl.ptr<vector<3xf32>>
  %v = rtsl.load %p : !rtsl.ptr<vector<3xf32>>
  %c = rtsl.trace %v, %v : vector<3xf32>
  return
}

// -----

// Another object's method is not: that object has to be kept. It is inlined.
// CHECK-LABEL: func.func @other
// CHECK-NOT:    call
// CHECK:        rtsl.trace
func.func @other(%o: !rtsl.ref<"A">, %b: !rtsl.ref<"A">) {
  call @A.shade(%b) : (!rtsl.ref<"A">) -> ()
  return
}
func.func private @A.shade(%self: !rtsl.ref<"A">) {
  %p = rtsl.state "HitPoint" : !rtsl.ptr<vector<3xf32>>
  %v = rtsl.load %p : !rtsl.ptr<vector<3xf32>>
  %c = rtsl.trace %v, %v : vector<3xf32>
  return
}

// -----

// What may be called while it runs cannot become part of itself: it gets a frame of its own.
// CHECK-LABEL: func.func @round
// CHECK-SAME:    attributes {rtsl.framed}
// CHECK:         rtsl.trace
// CHECK:         call @round({{.*}}) {rtsl.framed}
// CHECK-NOT:   @about
func.func @round(%d: vector<3xf32>) {
  %c = rtsl.trace %d, %d : vector<3xf32>
  call @about(%c) : (vector<3xf32>) -> ()
  return
}
func.func private @about(%d: vector<3xf32>) {
  call @round(%d) : (vector<3xf32>) -> ()
  return
}

// MUTATION inline-tracing of calls/InlineTracing.cpp: a call on another object counts as the caller's own
// -   if (ir::withoutCasts(call.getOperand(0)) != object)
// -     return false;
