// Constants fold as the operation computes them.
// RUN: rtsl-opt %s --canonicalize | FileCheck %s

// Correctly rounded, whatever the machine's libm computes: sin(2) = 0x3F68C7B7, exp(1) = 0x402DF854.
// CHECK-LABEL: func.func @elementary
// CHECK-DAG: %[[SIN:.*]] = arith.constant 0.909297406 : f32
// CHECK-DAG: %[[EXP:.*]] = arith.constant dense<2.71828175> : vector<3xf32>
// CHECK-DAG: %[[POW:.*]] = arith.constant 1.024000e+03 : f32
// CHECK: return %[[SIN]], %[[EXP]], %[[POW]]
func.func @elementary() -> (f32, vector<3xf32>, f32) {
  %two = arith.constant 2.0 : f32
  %ten = arith.constant 10.0 : f32
  %ones = arith.constant dense<1.0> : vector<3xf32>
  %s = rtsl.elementary <sin> %two : f32
  %e = rtsl.elementary <exp> %ones : vector<3xf32>
  %p = rtsl.elementary <pow> %two, %ten : f32
  return %s, %e, %p : f32, vector<3xf32>, f32
}

// CHECK-LABEL: func.func @toInt
// CHECK-DAG: %[[BIG:.*]] = arith.constant 2147483647 : i32
// CHECK-DAG: %[[ZERO:.*]] = arith.constant 0 : i32
// CHECK-DAG: %[[TRUNCATED:.*]] = arith.constant -2 : i32
// CHECK-DAG: %[[ALL:.*]] = arith.constant -1 : i32
// CHECK: return %[[BIG]], %[[ZERO]], %[[TRUNCATED]], %[[ALL]], %[[ZERO]]
func.func @toInt() -> (i32, i32, i32, i32, i32) {
  %huge = arith.constant 1.0e30 : f32
  %nan = arith.constant 0x7FC00000 : f32
  %minus = arith.constant -2.75 : f32
  %a = rtsl.to_sint %huge : f32
  %b = rtsl.to_sint %nan : f32
  %c = rtsl.to_sint %minus : f32
  %d = rtsl.to_uint %huge : f32
  %e = rtsl.to_uint %minus : f32
  return %a, %b, %c, %d, %e : i32, i32, i32, i32, i32
}

// CHECK-LABEL: func.func @division(
// CHECK-SAME: %[[X:.*]]: i32
// CHECK-DAG: %[[ZERO:.*]] = arith.constant 0 : i32
// CHECK-DAG: %[[SMALLEST:.*]] = arith.constant -2147483648 : i32
// CHECK-DAG: %[[THREE:.*]] = arith.constant -3 : i32
// CHECK-DAG: %[[UNSIGNED:.*]] = arith.constant 2147483644 : i32
// CHECK: return %[[ZERO]], %[[SMALLEST]], %[[ZERO]], %[[THREE]], %[[UNSIGNED]], %[[X]]
func.func @division(%x: i32) -> (i32, i32, i32, i32, i32, i32) {
  %zero = arith.constant 0 : i32
  %one = arith.constant 1 : i32
  %two = arith.constant 2 : i32
  %minusOne = arith.constant -1 : i32
  %minusSeven = arith.constant -7 : i32
  %smallest = arith.constant -2147483648 : i32
  %a = rtsl.sdiv %two, %zero : i32
  %b = rtsl.sdiv %smallest, %minusOne : i32
  %c = rtsl.srem %smallest, %minusOne : i32
  %d = rtsl.sdiv %minusSeven, %two : i32
  %e = rtsl.udiv %minusSeven, %two : i32
  %f = rtsl.sdiv %x, %one : i32
  return %a, %b, %c, %d, %e, %f : i32, i32, i32, i32, i32, i32
}

// CHECK-LABEL: func.func @references(
// CHECK-SAME: %[[R:.*]]: !rtsl.ref<"A">
// CHECK-DAG: %[[TRUE:.*]] = arith.constant true
// CHECK-DAG: %[[ZERO:.*]] = arith.constant 0 : i32
// CHECK: return %[[R]], %[[ZERO]], %[[TRUE]]
func.func @references(%r: !rtsl.ref<"A">) -> (!rtsl.ref<"A">, i32, i1) {
  %up = rtsl.cast_ref %r : !rtsl.ref<"A"> -> !rtsl.ref<"rt_Texture">
  %down = rtsl.cast_ref %up : !rtsl.ref<"rt_Texture"> -> !rtsl.ref<"A">
  %none = rtsl.null_ref : !rtsl.ref<"A">
  %id = rtsl.class_id %none : !rtsl.ref<"A">
  %same = rtsl.equal_ref %r, %up : !rtsl.ref<"A">, !rtsl.ref<"rt_Texture">
  return %down, %id, %same : !rtsl.ref<"A">, i32, i1
}

// CHECK-LABEL: func.func @copy(
// CHECK-SAME: %[[A:.*]]: !rtsl.ptr<f32>, %[[B:.*]]: !rtsl.ptr<f32>
// CHECK-NEXT: %[[V:.*]] = rtsl.load %[[A]]
// CHECK-NEXT: rtsl.store %[[V]], %[[B]]
// CHECK-NEXT: return
func.func @copy(%a: !rtsl.ptr<f32>, %b: !rtsl.ptr<f32>) {
  rtsl.copy %a to %b : !rtsl.ptr<f32>
  rtsl.copy %b to %b : !rtsl.ptr<f32>
  return
}
