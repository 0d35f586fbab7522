// Arms fall into the next unless they break.
// RUN: rtsl-opt %s --rtsl-to-cf --rtsl-hoist-vars --mem2reg --canonicalize --cse | FileCheck %s

// CHECK-LABEL: func.func @switch(
// CHECK-SAME: %[[ARG0:.*]]: i32) -> i32 {
// CHECK-NEXT: %[[C10_I32:.*]] = arith.constant 10 : i32
// CHECK-NEXT: cf.switch %[[ARG0]] : i32, [
// CHECK-NEXT: default: ^bb2,
// CHECK-NEXT: 1: ^bb1(%[[C10_I32]] : i32),
// CHECK-NEXT: 2: ^bb1(%[[C10_I32]] : i32),
// CHECK-NEXT: 3: ^bb1(%[[ARG0]] : i32)
// CHECK-NEXT: ]
// CHECK-NEXT: ^bb1(%[[V0:.*]]: i32):
// CHECK-NEXT: %[[V1:.*]] = arith.addi %[[V0]], %[[ARG0]] : i32
// CHECK-NEXT: return %[[V1]] : i32
// CHECK-NEXT: ^bb2:
// CHECK-NEXT: return %[[C10_I32]] : i32
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
