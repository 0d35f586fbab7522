// RUN: rtsl-opt %s --rtsl-insert-suspends --rtsl-save-live --rtsl-layout-frame --rtsl-split-states | FileCheck %s

// A state for the beginning and one for each trace; what both ways reach, ^done, is in both.
// CHECK-LABEL: func.func private @f.state0(%arg0: !rtsl.ref<"M">) -> i32
// CHECK:         rtsl.frame_store %[[W:.*]], "r"[0] : f32
// CHECK-NEXT:    rtsl.spawn
// CHECK-NEXT:    %[[NEXT:.*]] = rtsl.next trace @f.state1
// CHECK-NEXT:    rtsl.end %[[NEXT]]
// CHECK-NEXT:  ^bb2:
// CHECK:         rtsl.store
// CHECK:         rtsl.next done
// CHECK-LABEL: func.func private @f.state1(%arg0: !rtsl.ref<"M">) -> i32
// CHECK-NEXT:    rtsl.trace_result
// CHECK-NEXT:    rtsl.frame_load "r"[0] : f32
// CHECK:         rtsl.store
// CHECK-NEXT:    rtsl.next done
// CHECK-NOT:   func.func
func.func @f(%self: !rtsl.ref<"M">) {
  %a = rtsl.state "HitPoint" : !rtsl.ptr<vector<3xf32>>
  %o = rtsl.load %a : !rtsl.ptr<vector<3xf32>>
  %r = rtsl.rand loc("r")
  %p = arith.cmpf olt, %r, %r : f32
  cf.cond_br %p, ^trace, ^done(%r : f32)
^trace:
  %c = rtsl.trace %o, %o : vector<3xf32>
  %x = vector.extract %c[0] : f32 from vector<3xf32>
  %y = arith.addf %x, %r : f32
  cf.br ^done(%y : f32)
^done(%v: f32):
  %b = rtsl.state "PDF" : !rtsl.ptr<f32>
  rtsl.store %v, %b : !rtsl.ptr<f32>
  return
}

// MUTATION split-states of states/SplitStates.cpp: a ray returns to the state that sent it
// - ir::Transition::Trace, stateName(index + 1));
// + ir::Transition::Trace, stateName(index));
