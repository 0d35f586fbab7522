// Arms fall into the next unless they break.
// RUN: rtsl-opt %s --rtsl-to-cf | FileCheck %s

// CHECK-LABEL: func.func @switch(
// CHECK-SAME: %[[ARG0:.*]]: i32) -> i32 {
// CHECK-NEXT: %[[C10_I32:.*]] = arith.constant 10 : i32
// CHECK-NEXT: %[[R:.*]] = rtsl.var "r" : !rtsl.ptr<i32>
// CHECK-NEXT: rtsl.store %[[ARG0]], %[[R]] : !rtsl.ptr<i32>
// CHECK-NEXT: cf.switch %[[ARG0]] : i32, [
// CHECK-NEXT: default: ^bb3,
// CHECK-NEXT: 1: ^bb1,
// CHECK-NEXT: 2: ^bb1,
// CHECK-NEXT: 3: ^bb2
// CHECK-NEXT: ]
// CHECK-NEXT: ^bb1:
// CHECK-NEXT: rtsl.store %[[C10_I32]], %[[R]] : !rtsl.ptr<i32>
// CHECK-NEXT: cf.br ^bb2
// CHECK-NEXT: ^bb2:
// CHECK-NEXT: %[[V0:.*]] = rtsl.load %[[R]] : !rtsl.ptr<i32>
// CHECK-NEXT: %[[V1:.*]] = arith.addi %[[V0]], %[[ARG0]] : i32
// CHECK-NEXT: rtsl.store %[[V1]], %[[R]] : !rtsl.ptr<i32>
// CHECK-NEXT: cf.br ^bb4
// CHECK-NEXT: ^bb3:
// CHECK-NEXT: return %[[C10_I32]] : i32
// CHECK-NEXT: ^bb4:
// CHECK-NEXT: %[[V2:.*]] = rtsl.load %[[R]] : !rtsl.ptr<i32>
// CHECK-NEXT: return %[[V2]] : i32
// CHECK-NEXT: }
func.func @switch(%x: i32) -> i32 {
  %ten = arith.constant 10 : i32
  %r = rtsl.var "r" : !rtsl.ptr<i32>
  rtsl.store %x, %r : !rtsl.ptr<i32>
  rtsl.switch %x : i32 {
    arm [1, 2] {
      rtsl.store %ten, %r : !rtsl.ptr<i32>
      rtsl.yield
    }
    arm [3] {
      %v = rtsl.load %r : !rtsl.ptr<i32>
      %w = arith.addi %v, %x : i32
      rtsl.store %w, %r : !rtsl.ptr<i32>
      rtsl.break
    }
    arm default {
      rtsl.return %ten : i32
    }
  }
  %v = rtsl.load %r : !rtsl.ptr<i32>
  rtsl.return %v : i32
}
