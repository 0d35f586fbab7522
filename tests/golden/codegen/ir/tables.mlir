// RUN: rtsl-opt %s --canonicalize | FileCheck %s
// RUN: rtsl-opt %s | rtsl-opt | FileCheck %s --check-prefix=SAME

// What is read at a known index is a constant.
// CHECK-LABEL: func.func @fields(
// CHECK-DAG:     %[[ON:.*]] = arith.constant true
// CHECK-DAG:     %[[I:.*]] = arith.constant -1 : i32
// CHECK-DAG:     %[[V:.*]] = arith.constant dense<[1.000000e+00, 2.000000e+00]> : vector<2xf32>
// CHECK:         return %[[ON]], %[[I]], %[[V]]
// SAME-LABEL:  func.func @fields(
// SAME:          rtsl.table "pairs" [0, 0, 0, 0, 1, -1, 1065353216, 1073741824]
func.func @fields() -> (i1, i32, vector<2xf32>) {
  %one = arith.constant 1 : i32
  %t = rtsl.table "pairs" [0, 0, 0, 0, 1, -1, 1065353216, 1073741824]
      : !rtsl.ptr<!rtsl.array<2 x !rtsl.struct<"S", {on: i1, i: i32, v: vector<2xf32>}>>>
  %s = rtsl.element %t[%one] : !rtsl.ptr<!rtsl.array<2 x !rtsl.struct<"S", {on: i1, i: i32, v: vector<2xf32>}>>>
      -> !rtsl.ptr<!rtsl.struct<"S", {on: i1, i: i32, v: vector<2xf32>}>>
  %on = rtsl.field %s["on"] : !rtsl.ptr<!rtsl.struct<"S", {on: i1, i: i32, v: vector<2xf32>}>> -> !rtsl.ptr<i1>
  %i = rtsl.field %s["i"] : !rtsl.ptr<!rtsl.struct<"S", {on: i1, i: i32, v: vector<2xf32>}>> -> !rtsl.ptr<i32>
  %v = rtsl.field %s["v"] : !rtsl.ptr<!rtsl.struct<"S", {on: i1, i: i32, v: vector<2xf32>}>> -> !rtsl.ptr<vector<2xf32>>
  %a = rtsl.load %on : !rtsl.ptr<i1>
  %b = rtsl.load %i : !rtsl.ptr<i32>
  %c = rtsl.load %v : !rtsl.ptr<vector<2xf32>>
  return %a, %b, %c : i1, i32, vector<2xf32>
}

// An index that is not known, or lies outside (in code that never runs), stays.
// CHECK-LABEL: func.func @unknown(
// CHECK-COUNT-2: rtsl.load
func.func @unknown(%i: i32) -> (f32, f32) {
  %two = arith.constant 2 : i32
  %t = rtsl.table "t" [0, 1] : !rtsl.ptr<!rtsl.array<2 x f32>>
  %e = rtsl.element %t[%i] : !rtsl.ptr<!rtsl.array<2 x f32>> -> !rtsl.ptr<f32>
  %f = rtsl.element %t[%two] : !rtsl.ptr<!rtsl.array<2 x f32>> -> !rtsl.ptr<f32>
  %x = rtsl.load %e : !rtsl.ptr<f32>
  %y = rtsl.load %f : !rtsl.ptr<f32>
  return %x, %y : f32, f32
}
