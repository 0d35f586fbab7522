// A variable of a loop body moves to the entry, and becomes zero where it was.
// RUN: rtsl-opt %s --rtsl-hoist-vars | FileCheck %s

// CHECK-LABEL: func.func @f(
// CHECK-SAME: %[[ARG0:.*]]: i1) {
// CHECK-NEXT: %[[B:.*]] = rtsl.var "b" : !rtsl.ptr<f32>
// CHECK-NEXT: %[[T:.*]] = rtsl.var "t" : !rtsl.ptr<!rtsl.array<3 x f32>>
// CHECK-NEXT: %[[A:.*]] = rtsl.var "a" : !rtsl.ptr<f32>
// CHECK-NEXT: cf.br ^bb1
// CHECK-NEXT: ^bb1:
// CHECK-NEXT: rtsl.clear %[[B]] : !rtsl.ptr<f32>
// CHECK-NEXT: rtsl.clear %[[T]] : !rtsl.ptr<!rtsl.array<3 x f32>>
// CHECK-NEXT: rtsl.copy %[[A]] to %[[B]] : !rtsl.ptr<f32>
// CHECK-NEXT: cf.cond_br %[[ARG0]], ^bb1, ^bb2
// CHECK-NEXT: ^bb2:
// CHECK-NEXT: return
// CHECK-NEXT: }
func.func @f(%c: i1) {
  %a = rtsl.var "a" : !rtsl.ptr<f32>
  cf.br ^loop
^loop:
  %b = rtsl.var "b" : !rtsl.ptr<f32>
  %t = rtsl.var "t" : !rtsl.ptr<!rtsl.array<3 x f32>>
  rtsl.copy %a to %b : !rtsl.ptr<f32>
  cf.cond_br %c, ^loop, ^end
^end:
  return
}
