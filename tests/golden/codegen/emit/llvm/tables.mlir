// One private constant for all tables with the same words; loads of it may move anywhere.
// RUN: rtsl-opt %s --rtsl-to-llvm --cse | FileCheck %s
// RUN: rtsl-opt %s --rtsl-to-llvm | mlir-translate --mlir-to-llvmir | FileCheck %s --check-prefix=LLVM

// CHECK: llvm.mlir.global private unnamed_addr constant @constant.weights(dense<[1056964608, 1048576000]> : tensor<2xi32>) {addr_space = 0 : i32, alignment = 4 : i64} : !llvm.array<2 x i32>
// CHECK: llvm.mlir.global private unnamed_addr constant @constant.weights.1(dense<[1, 0, 7]> : tensor<3xi32>) {addr_space = 0 : i32, alignment = 4 : i64} : !llvm.array<3 x i32>
// LLVM-DAG: @constant.weights = private unnamed_addr constant [2 x i32] [i32 1056964608, i32 1048576000], align 4

// CHECK-LABEL: llvm.func @A.table(
// CHECK: %[[TABLE:.*]] = llvm.mlir.addressof @constant.weights : !llvm.ptr
// CHECK: llvm.getelementptr inbounds %[[TABLE]]
// CHECK: llvm.load %{{.*}} invariant
func.func @A.table(%i: i32) -> f32 {
  %table = rtsl.table "weights" [1056964608, 1048576000] : !rtsl.ptr<!rtsl.array<2 x f32>>
  %e = rtsl.element %table[%i] : !rtsl.ptr<!rtsl.array<2 x f32>> -> !rtsl.ptr<f32>
  %x = rtsl.load %e : !rtsl.ptr<f32>
  return %x : f32
}
// CHECK-LABEL: llvm.func @A.same(
// CHECK: llvm.mlir.addressof @constant.weights : !llvm.ptr
func.func @A.same(%i: i32) -> f32 {
  %table = rtsl.table "others" [1056964608, 1048576000] : !rtsl.ptr<!rtsl.array<2 x f32>>
  %e = rtsl.element %table[%i] : !rtsl.ptr<!rtsl.array<2 x f32>> -> !rtsl.ptr<f32>
  %x = rtsl.load %e : !rtsl.ptr<f32>
  return %x : f32
}
// CHECK-LABEL: llvm.func @A.different(
// CHECK: llvm.mlir.addressof @constant.weights.1 : !llvm.ptr
func.func @A.different(%i: i32) -> i32 {
  %table = rtsl.table "weights" [1, 0, 7] : !rtsl.ptr<!rtsl.array<3 x i32>>
  %e = rtsl.element %table[%i] : !rtsl.ptr<!rtsl.array<3 x i32>> -> !rtsl.ptr<i32>
  %x = rtsl.load %e : !rtsl.ptr<i32>
  return %x : i32
}
