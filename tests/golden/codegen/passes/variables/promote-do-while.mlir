// A loop that tests after its body.
// RUN: rtsl-opt %s --rtsl-to-cf --rtsl-hoist-vars --mem2reg --canonicalize --cse | FileCheck %s

// CHECK-LABEL: func.func @doWhile(
// CHECK-SAME: %[[ARG0:.*]]: i32) -> i32 {
// CHECK-NEXT: %[[C0_I32:.*]] = arith.constant 0 : i32
// CHECK-NEXT: %[[C1_I32:.*]] = arith.constant 1 : i32
// CHECK-NEXT: cf.br ^bb1(%[[C0_I32]] : i32)
// CHECK-NEXT: ^bb1(%[[V0:.*]]: i32):
// CHECK-NEXT: %[[V1:.*]] = arith.addi %[[V0]], %[[C1_I32]] : i32
// CHECK-NEXT: %[[V2:.*]] = arith.cmpi slt, %[[V1]], %[[ARG0]] : i32
// CHECK-NEXT: cf.cond_br %[[V2]], ^bb1(%[[V1]] : i32), ^bb2
// CHECK-NEXT: ^bb2:
// CHECK-NEXT: return %[[V1]] : i32
// CHECK-NEXT: }
func.func @doWhile(%n: i32) -> i32 {
  %one = arith.constant 1 : i32
  %i = rtsl.var "i" : !rtsl.ptr<i32>
  rtsl.loop post_test cond {
    %v = rtsl.load %i : !rtsl.ptr<i32>
    %c = arith.cmpi slt, %v, %n : i32
    rtsl.condition %c
  } do {
    %v = rtsl.load %i : !rtsl.ptr<i32>
    %w = arith.addi %v, %one : i32
    rtsl.store %w, %i : !rtsl.ptr<i32>
    rtsl.yield
  }
  %r = rtsl.load %i : !rtsl.ptr<i32>
  rtsl.return %r : i32
}
