// A reference is an offset; the class of the null reference is read from a record of its own.
// RUN: rtsl-opt %s --rtsl-to-llvm --cse | FileCheck %s

// CHECK: llvm.mlir.global internal constant @rtsl.null_record(0 : i32)

// CHECK-LABEL: llvm.func @A.classOf(
// CHECK-SAME: %[[ARG0:.*]]: !llvm.ptr {llvm.align = 8 : i64, llvm.dereferenceable = {{[0-9]+}} : i64, llvm.noalias, llvm.nonnull}, %[[ARG1:.*]]: i32) -> i32 attributes {no_unwind} {
// CHECK-NEXT: %[[V0:.*]] = llvm.load %[[ARG0]] {alignment = 8 : i64} : !llvm.ptr -> !llvm.ptr
// CHECK-NEXT: %[[V1:.*]] = llvm.load %[[V0]] invariant {alignment = 8 : i64} : !llvm.ptr -> !llvm.ptr
// CHECK-NEXT: %[[V2:.*]] = llvm.zext %[[ARG1]] : i32 to i64
// CHECK-NEXT: %[[V3:.*]] = llvm.getelementptr %[[V1]][%[[V2]]] : (!llvm.ptr, i64) -> !llvm.ptr, i8
// CHECK-NEXT: %[[V4:.*]] = llvm.mlir.addressof @rtsl.null_record : !llvm.ptr
// CHECK-NEXT: %[[V5:.*]] = llvm.mlir.constant(0 : i32) : i32
// CHECK-NEXT: %[[V6:.*]] = llvm.icmp "eq" %[[ARG1]], %[[V5]] : i32
// CHECK-NEXT: %[[V7:.*]] = llvm.select %[[V6]], %[[V4]], %[[V3]] : i1, !llvm.ptr
// CHECK-NEXT: %[[V8:.*]] = llvm.load %[[V7]] invariant {alignment = 4 : i64} : !llvm.ptr -> i32
// CHECK-NEXT: llvm.return %[[V8]] : i32
// CHECK-NEXT: }
func.func @A.classOf(%r: !rtsl.ref<"rt_Texture">) -> i32 {
  %id = rtsl.class_id %r : !rtsl.ref<"rt_Texture">
  return %id : i32
}
// CHECK-LABEL: llvm.func @A.compare(
// CHECK-SAME: %[[ARG0:.*]]: !llvm.ptr {llvm.align = 8 : i64, llvm.dereferenceable = {{[0-9]+}} : i64, llvm.noalias, llvm.nonnull}, %[[ARG1:.*]]: i32) -> i1 attributes {no_unwind} {
// CHECK-NEXT: %[[V0:.*]] = llvm.mlir.constant(0 : i32) : i32
// CHECK-NEXT: %[[V1:.*]] = llvm.icmp "eq" %[[ARG1]], %[[V0]] : i32
// CHECK-NEXT: llvm.return %[[V1]] : i1
// CHECK-NEXT: }
func.func @A.compare(%r: !rtsl.ref<"rt_Texture">) -> i1 {
  %none = rtsl.null_ref : !rtsl.ref<"A">
  %up = rtsl.cast_ref %none : !rtsl.ref<"A"> -> !rtsl.ref<"rt_Texture">
  %same = rtsl.equal_ref %r, %up : !rtsl.ref<"rt_Texture">, !rtsl.ref<"rt_Texture">
  return %same : i1
}
