// Copies of at most 64 leaves become loads and stores; larger ones stay for memcpy.
// RUN: rtsl-opt %s --rtsl-expand-copies --cse | FileCheck %s

!s = !rtsl.struct<"S", {a: f32, b: !rtsl.array<2 x i32>}>
!large = !rtsl.array<65 x f32>

// CHECK-LABEL: func.func @small(
// CHECK-SAME: %[[ARG0:.*]]: !rtsl.ptr<!rtsl.struct<"S", {a: f32, b: !rtsl.array<2 x i32>}>>, %[[ARG1:.*]]: !rtsl.ptr<!rtsl.struct<"S", {a: f32, b: !rtsl.array<2 x i32>}>>) {
// CHECK-NEXT: %[[V0:.*]] = rtsl.field %[[ARG0]]["a"] : !rtsl.ptr<!rtsl.struct<"S", {a: f32, b: !rtsl.array<2 x i32>}>> -> !rtsl.ptr<f32>
// CHECK-NEXT: %[[V1:.*]] = rtsl.field %[[ARG1]]["a"] : !rtsl.ptr<!rtsl.struct<"S", {a: f32, b: !rtsl.array<2 x i32>}>> -> !rtsl.ptr<f32>
// CHECK-NEXT: %[[V2:.*]] = rtsl.load %[[V0]] : !rtsl.ptr<f32>
// CHECK-NEXT: rtsl.store %[[V2]], %[[V1]] : !rtsl.ptr<f32>
// CHECK-NEXT: %[[V3:.*]] = rtsl.field %[[ARG0]]["b"] : !rtsl.ptr<!rtsl.struct<"S", {a: f32, b: !rtsl.array<2 x i32>}>> -> !rtsl.ptr<!rtsl.array<2 x i32>>
// CHECK-NEXT: %[[V4:.*]] = rtsl.field %[[ARG1]]["b"] : !rtsl.ptr<!rtsl.struct<"S", {a: f32, b: !rtsl.array<2 x i32>}>> -> !rtsl.ptr<!rtsl.array<2 x i32>>
// CHECK-NEXT: %[[C0_I32:.*]] = arith.constant 0 : i32
// CHECK-NEXT: %[[V5:.*]] = rtsl.element %[[V3]][%[[C0_I32]]] : !rtsl.ptr<!rtsl.array<2 x i32>> -> !rtsl.ptr<i32>
// CHECK-NEXT: %[[V6:.*]] = rtsl.element %[[V4]][%[[C0_I32]]] : !rtsl.ptr<!rtsl.array<2 x i32>> -> !rtsl.ptr<i32>
// CHECK-NEXT: %[[V7:.*]] = rtsl.load %[[V5]] : !rtsl.ptr<i32>
// CHECK-NEXT: rtsl.store %[[V7]], %[[V6]] : !rtsl.ptr<i32>
// CHECK-NEXT: %[[C1_I32:.*]] = arith.constant 1 : i32
// CHECK-NEXT: %[[V8:.*]] = rtsl.element %[[V3]][%[[C1_I32]]] : !rtsl.ptr<!rtsl.array<2 x i32>> -> !rtsl.ptr<i32>
// CHECK-NEXT: %[[V9:.*]] = rtsl.element %[[V4]][%[[C1_I32]]] : !rtsl.ptr<!rtsl.array<2 x i32>> -> !rtsl.ptr<i32>
// CHECK-NEXT: %[[V10:.*]] = rtsl.load %[[V8]] : !rtsl.ptr<i32>
// CHECK-NEXT: rtsl.store %[[V10]], %[[V9]] : !rtsl.ptr<i32>
// CHECK-NEXT: return
// CHECK-NEXT: }
func.func @small(%p: !rtsl.ptr<!s>, %q: !rtsl.ptr<!s>) {
  rtsl.copy %p to %q : !rtsl.ptr<!s>
  return
}
// CHECK-LABEL: func.func @zero(
// CHECK-SAME: %[[ARG0:.*]]: !rtsl.ptr<!rtsl.struct<"S", {a: f32, b: !rtsl.array<2 x i32>}>>) {
// CHECK-NEXT: %[[V0:.*]] = rtsl.field %[[ARG0]]["a"] : !rtsl.ptr<!rtsl.struct<"S", {a: f32, b: !rtsl.array<2 x i32>}>> -> !rtsl.ptr<f32>
// CHECK-NEXT: %[[CST:.*]] = arith.constant 0.000000e+00 : f32
// CHECK-NEXT: rtsl.store %[[CST]], %[[V0]] : !rtsl.ptr<f32>
// CHECK-NEXT: %[[V1:.*]] = rtsl.field %[[ARG0]]["b"] : !rtsl.ptr<!rtsl.struct<"S", {a: f32, b: !rtsl.array<2 x i32>}>> -> !rtsl.ptr<!rtsl.array<2 x i32>>
// CHECK-NEXT: %[[C0_I32:.*]] = arith.constant 0 : i32
// CHECK-NEXT: %[[V2:.*]] = rtsl.element %[[V1]][%[[C0_I32]]] : !rtsl.ptr<!rtsl.array<2 x i32>> -> !rtsl.ptr<i32>
// CHECK-NEXT: rtsl.store %[[C0_I32]], %[[V2]] : !rtsl.ptr<i32>
// CHECK-NEXT: %[[C1_I32:.*]] = arith.constant 1 : i32
// CHECK-NEXT: %[[V3:.*]] = rtsl.element %[[V1]][%[[C1_I32]]] : !rtsl.ptr<!rtsl.array<2 x i32>> -> !rtsl.ptr<i32>
// CHECK-NEXT: rtsl.store %[[C0_I32]], %[[V3]] : !rtsl.ptr<i32>
// CHECK-NEXT: return
// CHECK-NEXT: }
func.func @zero(%p: !rtsl.ptr<!s>) {
  rtsl.clear %p : !rtsl.ptr<!s>
  return
}
// CHECK-LABEL: func.func @large(
// CHECK-SAME: %[[ARG0:.*]]: !rtsl.ptr<!rtsl.array<65 x f32>>, %[[ARG1:.*]]: !rtsl.ptr<!rtsl.array<65 x f32>>) {
// CHECK-NEXT: rtsl.copy %[[ARG0]] to %[[ARG1]] : !rtsl.ptr<!rtsl.array<65 x f32>>
// CHECK-NEXT: rtsl.clear %[[ARG0]] : !rtsl.ptr<!rtsl.array<65 x f32>>
// CHECK-NEXT: return
// CHECK-NEXT: }
func.func @large(%p: !rtsl.ptr<!large>, %q: !rtsl.ptr<!large>) {
  rtsl.copy %p to %q : !rtsl.ptr<!large>
  rtsl.clear %p : !rtsl.ptr<!large>
  return
}
// CHECK-LABEL: func.func @buffer(
// CHECK-SAME: %[[ARG0:.*]]: !rtsl.ptr<!rtsl.buffer<f32, 1>>, %[[ARG1:.*]]: !rtsl.ptr<!rtsl.buffer<f32, 1>>) {
// CHECK-NEXT: rtsl.copy %[[ARG0]] to %[[ARG1]] : !rtsl.ptr<!rtsl.buffer<f32, 1>>
// CHECK-NEXT: return
// CHECK-NEXT: }
func.func @buffer(%p: !rtsl.ptr<!rtsl.buffer<f32, 1>>, %q: !rtsl.ptr<!rtsl.buffer<f32, 1>>) {
  rtsl.copy %p to %q : !rtsl.ptr<!rtsl.buffer<f32, 1>>
  return
}
