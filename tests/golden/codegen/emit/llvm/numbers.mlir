// Elementary functions are calls, one a component; division is defined for every operand.
// RUN: rtsl-opt %s --rtsl-to-llvm --cse | FileCheck %s

// CHECK: llvm.func @rtsl_pow(f32, f32) -> f32 attributes {memory_effects = #llvm.memory_effects<other = none, {{.*}}>, no_unwind, will_return}

// CHECK-LABEL: llvm.func @A.power(
// CHECK-SAME: %[[ARG0:.*]]: !llvm.ptr {llvm.align = 8 : i64, llvm.dereferenceable = {{[0-9]+}} : i64, llvm.noalias, llvm.nonnull}, %[[ARG1:.*]]: vector<2xf32>, %[[ARG2:.*]]: vector<2xf32>) -> vector<2xf32> attributes {no_unwind} {
// CHECK-NEXT: %[[V0:.*]] = llvm.mlir.constant(0 : i64) : i64
// CHECK-NEXT: %[[V1:.*]] = llvm.extractelement %[[ARG1]][%[[V0]] : i64] : vector<2xf32>
// CHECK-NEXT: %[[V2:.*]] = llvm.mlir.constant(1 : i64) : i64
// CHECK-NEXT: %[[V3:.*]] = llvm.extractelement %[[ARG1]][%[[V2]] : i64] : vector<2xf32>
// CHECK-NEXT: %[[V4:.*]] = llvm.extractelement %[[ARG2]][%[[V0]] : i64] : vector<2xf32>
// CHECK-NEXT: %[[V5:.*]] = llvm.extractelement %[[ARG2]][%[[V2]] : i64] : vector<2xf32>
// CHECK-NEXT: %[[V6:.*]] = llvm.mlir.poison : vector<2xf32>
// CHECK-NEXT: %[[V7:.*]] = llvm.call @rtsl_pow(%[[V1]], %[[V4]]) : (f32, f32) -> f32
// CHECK-NEXT: %[[V8:.*]] = llvm.insertelement %[[V7]], %[[V6]][%[[V0]] : i64] : vector<2xf32>
// CHECK-NEXT: %[[V9:.*]] = llvm.call @rtsl_pow(%[[V3]], %[[V5]]) : (f32, f32) -> f32
// CHECK-NEXT: %[[V10:.*]] = llvm.insertelement %[[V9]], %[[V8]][%[[V2]] : i64] : vector<2xf32>
// CHECK-NEXT: llvm.return %[[V10]] : vector<2xf32>
// CHECK-NEXT: }
func.func @A.power(%v: vector<2xf32>, %w: vector<2xf32>) -> vector<2xf32> {
  %p = rtsl.elementary <pow> %v, %w : vector<2xf32>
  return %p : vector<2xf32>
}
// CHECK-LABEL: llvm.func @A.toInt(
// CHECK-SAME: %[[ARG0:.*]]: !llvm.ptr {llvm.align = 8 : i64, llvm.dereferenceable = {{[0-9]+}} : i64, llvm.noalias, llvm.nonnull}, %[[ARG1:.*]]: f32, %[[ARG2:.*]]: vector<3xf32>) -> vector<3xi32> attributes {no_unwind} {
// CHECK-NEXT: %[[V0:.*]] = llvm.call_intrinsic "llvm.fptosi.sat"(%[[ARG1]]) : (f32) -> i32
// CHECK-NEXT: %[[V1:.*]] = llvm.call_intrinsic "llvm.fptoui.sat"(%[[ARG2]]) : (vector<3xf32>) -> vector<3xi32>
// CHECK-NEXT: %[[V2:.*]] = llvm.mlir.poison : vector<3xi32>
// CHECK-NEXT: %[[V3:.*]] = llvm.mlir.constant(0 : i32) : i32
// CHECK-NEXT: %[[V4:.*]] = llvm.insertelement %[[V0]], %[[V2]][%[[V3]] : i32] : vector<3xi32>
// CHECK-NEXT: %[[V5:.*]] = llvm.shufflevector %[[V4]], %[[V2]] [0, 0, 0] : vector<3xi32>
// CHECK-NEXT: %[[V6:.*]] = llvm.add %[[V5]], %[[V1]] : vector<3xi32>
// CHECK-NEXT: llvm.return %[[V6]] : vector<3xi32>
// CHECK-NEXT: }
func.func @A.toInt(%x: f32, %v: vector<3xf32>) -> vector<3xi32> {
  %i = rtsl.to_sint %x : f32
  %w = rtsl.to_uint %v : vector<3xf32>
  %b = vector.broadcast %i : i32 to vector<3xi32>
  %s = arith.addi %b, %w : vector<3xi32>
  return %s : vector<3xi32>
}
// CHECK-LABEL: llvm.func @A.signed(
// CHECK-SAME: %[[ARG0:.*]]: !llvm.ptr {llvm.align = 8 : i64, llvm.dereferenceable = {{[0-9]+}} : i64, llvm.noalias, llvm.nonnull}, %[[ARG1:.*]]: i32, %[[ARG2:.*]]: i32) -> i32 attributes {no_unwind} {
// CHECK-NEXT: %[[V0:.*]] = llvm.mlir.constant(0 : i32) : i32
// CHECK-NEXT: %[[V1:.*]] = llvm.icmp "eq" %[[ARG2]], %[[V0]] : i32
// CHECK-NEXT: %[[V2:.*]] = llvm.mlir.constant(-2147483648 : i32) : i32
// CHECK-NEXT: %[[V3:.*]] = llvm.icmp "eq" %[[ARG1]], %[[V2]] : i32
// CHECK-NEXT: %[[V4:.*]] = llvm.mlir.constant(-1 : i32) : i32
// CHECK-NEXT: %[[V5:.*]] = llvm.icmp "eq" %[[ARG2]], %[[V4]] : i32
// CHECK-NEXT: %[[V6:.*]] = llvm.and %[[V5]], %[[V3]] : i1
// CHECK-NEXT: %[[V7:.*]] = llvm.or %[[V1]], %[[V6]] : i1
// CHECK-NEXT: %[[V8:.*]] = llvm.mlir.constant(1 : i32) : i32
// CHECK-NEXT: %[[V9:.*]] = llvm.select %[[V7]], %[[V8]], %[[ARG2]] : i1, i32
// CHECK-NEXT: %[[V10:.*]] = llvm.sdiv %[[ARG1]], %[[V9]] : i32
// CHECK-NEXT: %[[V11:.*]] = llvm.select %[[V1]], %[[V0]], %[[V10]] : i1, i32
// CHECK-NEXT: llvm.return %[[V11]] : i32
// CHECK-NEXT: }
func.func @A.signed(%a: i32, %b: i32) -> i32 {
  %q = rtsl.sdiv %a, %b : i32
  return %q : i32
}
// CHECK-LABEL: llvm.func @A.unsigned(
// CHECK-SAME: %[[ARG0:.*]]: !llvm.ptr {llvm.align = 8 : i64, llvm.dereferenceable = {{[0-9]+}} : i64, llvm.noalias, llvm.nonnull}, %[[ARG1:.*]]: vector<2xi32>, %[[ARG2:.*]]: vector<2xi32>) -> vector<2xi32> attributes {no_unwind} {
// CHECK-NEXT: %[[V0:.*]] = llvm.mlir.constant(dense<0> : vector<2xi32>) : vector<2xi32>
// CHECK-NEXT: %[[V1:.*]] = llvm.icmp "eq" %[[ARG2]], %[[V0]] : vector<2xi32>
// CHECK-NEXT: %[[V2:.*]] = llvm.mlir.constant(dense<1> : vector<2xi32>) : vector<2xi32>
// CHECK-NEXT: %[[V3:.*]] = llvm.select %[[V1]], %[[V2]], %[[ARG2]] : vector<2xi1>, vector<2xi32>
// CHECK-NEXT: %[[V4:.*]] = llvm.urem %[[ARG1]], %[[V3]] : vector<2xi32>
// CHECK-NEXT: llvm.return %[[V4]] : vector<2xi32>
// CHECK-NEXT: }
func.func @A.unsigned(%a: vector<2xi32>, %b: vector<2xi32>) -> vector<2xi32> {
  %r = rtsl.urem %a, %b : vector<2xi32>
  return %r : vector<2xi32>
}
