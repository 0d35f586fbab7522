// RUN: rtsl-opt %s --rtsl-insert-suspends | FileCheck %s

// A block ends at each trace; the next one begins with the color that the ray returns.
// CHECK-LABEL: func.func @twice
// CHECK-NEXT:   rtsl.suspend %arg0, %arg1, ^bb1
// CHECK-NEXT: ^bb1:  // pred: ^bb0
// CHECK-NEXT:   %[[A:.*]] = rtsl.trace_result : vector<3xf32>
// CHECK-NEXT:   rtsl.suspend %arg0, %[[A]], ^bb2
// CHECK-NEXT: ^bb2:  // pred: ^bb1
// CHECK-NEXT:   %[[B:.*]] = rtsl.trace_result : vector<3xf32>
// CHECK-NEXT:   arith.addf %[[A]], %[[B]]
// CHECK-NEXT:   return
func.func @twice(%o: vector<3xf32>, %d: vector<3xf32>) {
  %a = rtsl.trace %o, %d : vector<3xf32>
  %b = rtsl.trace %o, %a : vector<3xf32>
  %sum = arith.addf %a, %b : vector<3xf32>
  return
}

// What cannot be reached is not split.
// CHECK-LABEL: func.func @unreachable
// CHECK-NEXT:   return
// CHECK-NEXT: }
func.func @unreachable(%o: vector<3xf32>) {
  return
^never:
  %c = rtsl.trace %o, %o : vector<3xf32>
  return
}

// MUTATION insert-suspends of suspend/InsertSuspends.cpp: how a ray is searched for gets lost
// - trace.getRayTypeAttr(), trace.getHowAttr(),
// + trace.getRayTypeAttr(), nullptr,
