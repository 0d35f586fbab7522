// The first index is the slowest, sizes come from the descriptor; all of it is constant for a launch.
// RUN: rtsl-opt %s --rtsl-to-llvm --cse | FileCheck %s

rtsl.class @Grid root "rt_Primitive" {
  rtsl.member_decl @cells : !rtsl.buffer<vector<3xf32>, 3> access "public"
}
// CHECK-LABEL: llvm.func @Grid.cell(
// CHECK-SAME: %[[ARG0:.*]]: !llvm.ptr {llvm.align = 8 : i64, llvm.dereferenceable = {{[0-9]+}} : i64, llvm.noalias, llvm.nonnull}, %[[ARG1:.*]]: i32, %[[ARG2:.*]]: i32, %[[ARG3:.*]]: i32, %[[ARG4:.*]]: i32) -> vector<3xf32> attributes {no_unwind} {
// CHECK-NEXT: %[[V0:.*]] = llvm.load %[[ARG0]] {alignment = 8 : i64} : !llvm.ptr -> !llvm.ptr
// CHECK-NEXT: %[[V1:.*]] = llvm.load %[[V0]] invariant {alignment = 8 : i64} : !llvm.ptr -> !llvm.ptr
// CHECK-NEXT: %[[V2:.*]] = llvm.zext %[[ARG1]] : i32 to i64
// CHECK-NEXT: %[[V3:.*]] = llvm.getelementptr inbounds %[[V1]][%[[V2]]] : (!llvm.ptr, i64) -> !llvm.ptr, !llvm.array<1 x i8>
// CHECK-NEXT: %[[V4:.*]] = llvm.getelementptr inbounds|nuw %[[V3]][4] : (!llvm.ptr) -> !llvm.ptr, i8
// CHECK-NEXT: %[[V5:.*]] = llvm.load %[[V4]] invariant {alignment = 4 : i64} : !llvm.ptr -> !llvm.ptr
// CHECK-NEXT: %[[V6:.*]] = llvm.zext %[[ARG2]] : i32 to i64
// CHECK-NEXT: %[[V7:.*]] = llvm.getelementptr inbounds|nuw %[[V4]][12] : (!llvm.ptr) -> !llvm.ptr, i8
// CHECK-NEXT: %[[V8:.*]] = llvm.load %[[V7]] invariant {alignment = 4 : i64} : !llvm.ptr -> i32
// CHECK-NEXT: %[[V9:.*]] = llvm.zext %[[V8]] : i32 to i64
// CHECK-NEXT: %[[V10:.*]] = llvm.mul %[[V6]], %[[V9]] : i64
// CHECK-NEXT: %[[V11:.*]] = llvm.zext %[[ARG3]] : i32 to i64
// CHECK-NEXT: %[[V12:.*]] = llvm.add %[[V10]], %[[V11]] : i64
// CHECK-NEXT: %[[V13:.*]] = llvm.getelementptr inbounds|nuw %[[V4]][16] : (!llvm.ptr) -> !llvm.ptr, i8
// CHECK-NEXT: %[[V14:.*]] = llvm.load %[[V13]] invariant {alignment = 4 : i64} : !llvm.ptr -> i32
// CHECK-NEXT: %[[V15:.*]] = llvm.zext %[[V14]] : i32 to i64
// CHECK-NEXT: %[[V16:.*]] = llvm.mul %[[V12]], %[[V15]] : i64
// CHECK-NEXT: %[[V17:.*]] = llvm.zext %[[ARG4]] : i32 to i64
// CHECK-NEXT: %[[V18:.*]] = llvm.add %[[V16]], %[[V17]] : i64
// CHECK-NEXT: %[[V19:.*]] = llvm.getelementptr inbounds %[[V5]][%[[V18]]] : (!llvm.ptr, i64) -> !llvm.ptr, !llvm.array<12 x i8>
// CHECK-NEXT: %[[V20:.*]] = llvm.load %[[V19]] invariant {alignment = 4 : i64} : !llvm.ptr -> vector<3xf32>
// CHECK-NEXT: llvm.return %[[V20]] : vector<3xf32>
// CHECK-NEXT: }
func.func @Grid.cell(%self: !rtsl.ref<"Grid">, %i: i32, %j: i32, %k: i32) -> vector<3xf32> {
  %b = rtsl.member %self["cells"] : !rtsl.ref<"Grid"> -> !rtsl.ptr<!rtsl.buffer<vector<3xf32>, 3>>
  %p = rtsl.buffer_element %b[%i, %j, %k] : !rtsl.ptr<!rtsl.buffer<vector<3xf32>, 3>> -> !rtsl.ptr<vector<3xf32>>
  %v = rtsl.load %p : !rtsl.ptr<vector<3xf32>>
  return %v : vector<3xf32>
}
// CHECK-LABEL: llvm.func @Grid.length(
// CHECK-SAME: %[[ARG0:.*]]: !llvm.ptr {llvm.align = 8 : i64, llvm.dereferenceable = {{[0-9]+}} : i64, llvm.noalias, llvm.nonnull}, %[[ARG1:.*]]: i32) -> i32 attributes {no_unwind} {
// CHECK-NEXT: %[[V0:.*]] = llvm.load %[[ARG0]] {alignment = 8 : i64} : !llvm.ptr -> !llvm.ptr
// CHECK-NEXT: %[[V1:.*]] = llvm.load %[[V0]] invariant {alignment = 8 : i64} : !llvm.ptr -> !llvm.ptr
// CHECK-NEXT: %[[V2:.*]] = llvm.zext %[[ARG1]] : i32 to i64
// CHECK-NEXT: %[[V3:.*]] = llvm.getelementptr inbounds %[[V1]][%[[V2]]] : (!llvm.ptr, i64) -> !llvm.ptr, !llvm.array<1 x i8>
// CHECK-NEXT: %[[V4:.*]] = llvm.getelementptr inbounds|nuw %[[V3]][4] : (!llvm.ptr) -> !llvm.ptr, i8
// CHECK-NEXT: %[[V5:.*]] = llvm.getelementptr inbounds|nuw %[[V4]][12] : (!llvm.ptr) -> !llvm.ptr, i8
// CHECK-NEXT: %[[V6:.*]] = llvm.load %[[V5]] invariant {alignment = 4 : i64} : !llvm.ptr -> i32
// CHECK-NEXT: llvm.return %[[V6]] : i32
// CHECK-NEXT: }
func.func @Grid.length(%self: !rtsl.ref<"Grid">) -> i32 {
  %b = rtsl.member %self["cells"] : !rtsl.ref<"Grid"> -> !rtsl.ptr<!rtsl.buffer<vector<3xf32>, 3>>
  %n = rtsl.buffer_length %b, 1 : !rtsl.ptr<!rtsl.buffer<vector<3xf32>, 3>>
  return %n : i32
}
