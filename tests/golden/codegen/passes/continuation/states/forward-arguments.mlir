// Arguments of blocks to which one value comes in a state, though several came before the cut.
// RUN: rtsl-opt %s --rtsl-insert-suspends --rtsl-save-live --rtsl-layout-frame --rtsl-split-states | FileCheck %s

// Behind the trace the loop is entered at ^body and at ^step; round it %n goes on as what was saved.
// CHECK-LABEL: func.func private @f.state1(
// CHECK:         %[[N:.*]] = rtsl.frame_load "n"
// CHECK:         cf.cond_br %{{.*}}, ^bb2, ^bb1
// CHECK:       ^bb1:
// CHECK-NEXT:    %[[R:.*]] = rtsl.rand
// CHECK-NEXT:    %[[AGAIN:.*]] = arith.cmpf olt, %[[R]], %[[N]]
// CHECK-NEXT:    cf.cond_br %[[AGAIN]], ^bb2, ^bb3
// CHECK:       ^bb2:
// CHECK-NEXT:    rtsl.state "PDF"
// CHECK-NEXT:    rtsl.store %[[N]]
// CHECK-NEXT:    cf.br ^bb1
func.func @f(%self: !rtsl.ref<"M">) {
  %a = rtsl.state "HitPoint" : !rtsl.ptr<vector<3xf32>>
  %o = rtsl.load %a : !rtsl.ptr<vector<3xf32>>
  %n0 = rtsl.rand loc("n")
  %n1 = rtsl.rand loc("n")
  %p = arith.cmpf olt, %n0, %n1 : f32
  cf.cond_br %p, ^trace(%n0 : f32), ^trace(%n1 : f32)
^trace(%n: f32 loc("n")):
  %c = rtsl.trace %o, %o : vector<3xf32>
  %x = vector.extract %c[0] : f32 from vector<3xf32>
  %q = arith.cmpf olt, %x, %x : f32
  cf.cond_br %q, ^body(%n : f32), ^step(%n : f32)
^body(%inner: f32 loc("n")):
  %b = rtsl.state "PDF" : !rtsl.ptr<f32>
  rtsl.store %inner, %b : !rtsl.ptr<f32>
  cf.br ^step(%inner : f32)
^step(%outer: f32 loc("n")):
  %r = rtsl.rand
  %again = arith.cmpf olt, %r, %outer : f32
  cf.cond_br %again, ^body(%outer : f32), ^done
^done:
  return
}
