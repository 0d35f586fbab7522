// A struct falls apart into its fields, copies and all; nested arrays with constant indices too.
// RUN: rtsl-opt %s --sroa --mem2reg --canonicalize --cse | FileCheck %s

!inner = !rtsl.array<2 x f32>
!pair = !rtsl.struct<"Pair", {first: f32, second: vector<3xf32>, both: !inner}>

// CHECK-LABEL: func.func @fields(
// CHECK-SAME: %[[ARG0:.*]]: f32, %[[ARG1:.*]]: vector<3xf32>) -> (f32, vector<3xf32>, f32, f32) {
// CHECK-NEXT: %[[CST:.*]] = arith.constant 0.000000e+00 : f32
// CHECK-NEXT: return %[[ARG0]], %[[ARG1]], %[[ARG0]], %[[CST]] : f32, vector<3xf32>, f32, f32
// CHECK-NEXT: }
func.func @fields(%x: f32, %v: vector<3xf32>) -> (f32, vector<3xf32>, f32, f32) {
  %one = arith.constant 1 : i32
  %p = rtsl.var "p" : !rtsl.ptr<!pair>
  %q = rtsl.var "q" : !rtsl.ptr<!pair>
  %first = rtsl.field %p["first"] : !rtsl.ptr<!pair> -> !rtsl.ptr<f32>
  rtsl.store %x, %first : !rtsl.ptr<f32>
  %second = rtsl.field %p["second"] : !rtsl.ptr<!pair> -> !rtsl.ptr<vector<3xf32>>
  rtsl.store %v, %second : !rtsl.ptr<vector<3xf32>>
  %both = rtsl.field %p["both"] : !rtsl.ptr<!pair> -> !rtsl.ptr<!inner>
  %b1 = rtsl.element %both[%one] : !rtsl.ptr<!inner> -> !rtsl.ptr<f32>
  rtsl.store %x, %b1 : !rtsl.ptr<f32>
  rtsl.copy %p to %q : !rtsl.ptr<!pair>
  rtsl.clear %p : !rtsl.ptr<!pair>
  %qf = rtsl.field %q["first"] : !rtsl.ptr<!pair> -> !rtsl.ptr<f32>
  %r0 = rtsl.load %qf : !rtsl.ptr<f32>
  %qs = rtsl.field %q["second"] : !rtsl.ptr<!pair> -> !rtsl.ptr<vector<3xf32>>
  %r1 = rtsl.load %qs : !rtsl.ptr<vector<3xf32>>
  %qb = rtsl.field %q["both"] : !rtsl.ptr<!pair> -> !rtsl.ptr<!inner>
  %qb1 = rtsl.element %qb[%one] : !rtsl.ptr<!inner> -> !rtsl.ptr<f32>
  %r2 = rtsl.load %qb1 : !rtsl.ptr<f32>
  %r3 = rtsl.load %first : !rtsl.ptr<f32>
  return %r0, %r1, %r2, %r3 : f32, vector<3xf32>, f32, f32
}
// CHECK-LABEL: func.func @fromMember(
// CHECK-SAME: %[[ARG0:.*]]: !rtsl.ptr<!rtsl.struct<"Pair", {first: f32, second: vector<3xf32>, both: !rtsl.array<2 x f32>}>>) -> f32 {
// CHECK-NEXT: %[[V0:.*]] = rtsl.field %[[ARG0]]["first"] : !rtsl.ptr<!rtsl.struct<"Pair", {first: f32, second: vector<3xf32>, both: !rtsl.array<2 x f32>}>> -> !rtsl.ptr<f32>
// CHECK-NEXT: %[[V1:.*]] = rtsl.load %[[V0]] : !rtsl.ptr<f32>
// CHECK-NEXT: return %[[V1]] : f32
// CHECK-NEXT: }
func.func @fromMember(%p: !rtsl.ptr<!pair>) -> f32 {
  %q = rtsl.var "q" : !rtsl.ptr<!pair>
  rtsl.copy %p to %q : !rtsl.ptr<!pair>
  %qf = rtsl.field %q["first"] : !rtsl.ptr<!pair> -> !rtsl.ptr<f32>
  %r0 = rtsl.load %qf : !rtsl.ptr<f32>
  return %r0 : f32
}
