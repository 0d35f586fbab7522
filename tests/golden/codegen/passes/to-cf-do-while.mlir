// A loop that tests after its body.
// RUN: rtsl-opt %s --rtsl-to-cf | FileCheck %s

// CHECK-LABEL: func.func @doWhile(
// CHECK-SAME: %[[ARG0:.*]]: i32) -> i32 {
// CHECK-NEXT: %[[C1_I32:.*]] = arith.constant 1 : i32
// CHECK-NEXT: %[[I:.*]] = rtsl.var "i" : !rtsl.ptr<i32>
// CHECK-NEXT: cf.br ^bb1
// CHECK-NEXT: ^bb1:
// CHECK-NEXT: %[[V0:.*]] = rtsl.load %[[I]] : !rtsl.ptr<i32>
// CHECK-NEXT: %[[V1:.*]] = arith.addi %[[V0]], %[[C1_I32]] : i32
// CHECK-NEXT: rtsl.store %[[V1]], %[[I]] : !rtsl.ptr<i32>
// CHECK-NEXT: cf.br ^bb2
// CHECK-NEXT: ^bb2:
// CHECK-NEXT: %[[V2:.*]] = rtsl.load %[[I]] : !rtsl.ptr<i32>
// CHECK-NEXT: %[[V3:.*]] = arith.cmpi slt, %[[V2]], %[[ARG0]] : i32
// CHECK-NEXT: cf.cond_br %[[V3]], ^bb1, ^bb3
// CHECK-NEXT: ^bb3:
// CHECK-NEXT: %[[V4:.*]] = rtsl.load %[[I]] : !rtsl.ptr<i32>
// CHECK-NEXT: return %[[V4]] : i32
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
