// An array whose indices are constant becomes values; one with an index from run time stays in memory. What is read before
// it is written is zero.
// RUN: rtsl-opt %s --sroa --mem2reg --canonicalize --cse | FileCheck %s

!a = !rtsl.array<2 x f32>
!m = !rtsl.array<2 x vector<2xf32>>

// CHECK-LABEL: func.func @constant(
// CHECK-SAME: %[[ARG0:.*]]: f32) -> (f32, f32) {
// CHECK-NEXT: %[[CST:.*]] = arith.constant 0.000000e+00 : f32
// CHECK-NEXT: return %[[ARG0]], %[[CST]] : f32, f32
// CHECK-NEXT: }
func.func @constant(%x: f32) -> (f32, f32) {
  %zero = arith.constant 0 : i32
  %one = arith.constant 1 : i32
  %a = rtsl.var "a" : !rtsl.ptr<!a>
  %e0 = rtsl.element %a[%zero] : !rtsl.ptr<!a> -> !rtsl.ptr<f32>
  %e1 = rtsl.element %a[%one] : !rtsl.ptr<!a> -> !rtsl.ptr<f32>
  rtsl.store %x, %e0 : !rtsl.ptr<f32>
  %r0 = rtsl.load %e0 : !rtsl.ptr<f32>
  %r1 = rtsl.load %e1 : !rtsl.ptr<f32>
  return %r0, %r1 : f32, f32
}
// CHECK-LABEL: func.func @dynamic(
// CHECK-SAME: %[[ARG0:.*]]: f32, %[[ARG1:.*]]: i32) -> f32 {
// CHECK-NEXT: %[[C1_I32:.*]] = arith.constant 1 : i32
// CHECK-NEXT: %[[A:.*]] = rtsl.var "a" : !rtsl.ptr<!rtsl.array<2 x f32>>
// CHECK-NEXT: %[[V0:.*]] = rtsl.element %[[A]][%[[C1_I32]]] : !rtsl.ptr<!rtsl.array<2 x f32>> -> !rtsl.ptr<f32>
// CHECK-NEXT: rtsl.store %[[ARG0]], %[[V0]] : !rtsl.ptr<f32>
// CHECK-NEXT: %[[V1:.*]] = rtsl.element %[[A]][%[[ARG1]]] : !rtsl.ptr<!rtsl.array<2 x f32>> -> !rtsl.ptr<f32>
// CHECK-NEXT: %[[V2:.*]] = rtsl.load %[[V1]] : !rtsl.ptr<f32>
// CHECK-NEXT: return %[[V2]] : f32
// CHECK-NEXT: }
func.func @dynamic(%x: f32, %i: i32) -> f32 {
  %one = arith.constant 1 : i32
  %a = rtsl.var "a" : !rtsl.ptr<!a>
  %e1 = rtsl.element %a[%one] : !rtsl.ptr<!a> -> !rtsl.ptr<f32>
  rtsl.store %x, %e1 : !rtsl.ptr<f32>
  %e = rtsl.element %a[%i] : !rtsl.ptr<!a> -> !rtsl.ptr<f32>
  %r = rtsl.load %e : !rtsl.ptr<f32>
  return %r : f32
}
// CHECK-LABEL: func.func @matrix(
// CHECK-SAME: %[[ARG0:.*]]: vector<2xf32>) -> vector<2xf32> {
// CHECK-NEXT: return %[[ARG0]] : vector<2xf32>
// CHECK-NEXT: }
func.func @matrix(%v: vector<2xf32>) -> vector<2xf32> {
  %one = arith.constant 1 : i32
  %m = rtsl.var "m" : !rtsl.ptr<!m>
  %n = rtsl.var "n" : !rtsl.ptr<!m>
  %c = rtsl.element %m[%one] : !rtsl.ptr<!m> -> !rtsl.ptr<vector<2xf32>>
  rtsl.store %v, %c : !rtsl.ptr<vector<2xf32>>
  rtsl.copy %m to %n : !rtsl.ptr<!m>
  %d = rtsl.element %n[%one] : !rtsl.ptr<!m> -> !rtsl.ptr<vector<2xf32>>
  %r = rtsl.load %d : !rtsl.ptr<vector<2xf32>>
  return %r : vector<2xf32>
}
