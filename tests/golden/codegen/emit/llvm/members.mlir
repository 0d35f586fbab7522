// Members follow the class id; a load is invariant but in constructors and in what they call.
// RUN: rtsl-opt %s --rtsl-to-llvm --cse | FileCheck %s

rtsl.class @Glass root "rt_Material" {
  rtsl.member_decl @n : vector<3xf32> access "scratch"
  rtsl.member_decl @tint : vector<3xf32> access "public"
  rtsl.member_decl @eta : f32 access "private"
}
// CHECK-LABEL: llvm.func @Glass.shade(
// CHECK-SAME: %[[ARG0:.*]]: !llvm.ptr {llvm.align = 8 : i64, llvm.dereferenceable = {{[0-9]+}} : i64, llvm.noalias, llvm.nonnull}, %[[ARG1:.*]]: i32) -> f32 attributes {no_unwind} {
// CHECK-NEXT: %[[V0:.*]] = llvm.load %[[ARG0]] {alignment = 8 : i64} : !llvm.ptr -> !llvm.ptr
// CHECK-NEXT: %[[V1:.*]] = llvm.load %[[V0]] invariant {alignment = 8 : i64} : !llvm.ptr -> !llvm.ptr
// CHECK-NEXT: %[[V2:.*]] = llvm.zext %[[ARG1]] : i32 to i64
// CHECK-NEXT: %[[V3:.*]] = llvm.getelementptr inbounds %[[V1]][%[[V2]]] : (!llvm.ptr, i64) -> !llvm.ptr, !llvm.array<1 x i8>
// CHECK-NEXT: %[[V4:.*]] = llvm.getelementptr inbounds|nuw %[[V3]][16] : (!llvm.ptr) -> !llvm.ptr, i8
// CHECK-NEXT: %[[V5:.*]] = llvm.load %[[V4]] invariant {alignment = 4 : i64} : !llvm.ptr -> f32
// CHECK-NEXT: llvm.return %[[V5]] : f32
// CHECK-NEXT: }
func.func @Glass.shade(%self: !rtsl.ref<"Glass">) -> f32 {
  %eta = rtsl.member %self["eta"] : !rtsl.ref<"Glass"> -> !rtsl.ptr<f32>
  %e = rtsl.load %eta : !rtsl.ptr<f32>
  return %e : f32
}
// CHECK-LABEL: llvm.func @Glass.constructor(
// CHECK-SAME: %[[ARG0:.*]]: !llvm.ptr {llvm.align = 8 : i64, llvm.dereferenceable = {{[0-9]+}} : i64, llvm.noalias, llvm.nonnull}, %[[ARG1:.*]]: i32) attributes {no_unwind} {
// CHECK-NEXT: %[[V0:.*]] = llvm.load %[[ARG0]] {alignment = 8 : i64} : !llvm.ptr -> !llvm.ptr
// CHECK-NEXT: %[[V1:.*]] = llvm.load %[[V0]] invariant {alignment = 8 : i64} : !llvm.ptr -> !llvm.ptr
// CHECK-NEXT: %[[V2:.*]] = llvm.zext %[[ARG1]] : i32 to i64
// CHECK-NEXT: %[[V3:.*]] = llvm.getelementptr inbounds %[[V1]][%[[V2]]] : (!llvm.ptr, i64) -> !llvm.ptr, !llvm.array<1 x i8>
// CHECK-NEXT: %[[V4:.*]] = llvm.getelementptr inbounds|nuw %[[V3]][16] : (!llvm.ptr) -> !llvm.ptr, i8
// CHECK-NEXT: %[[V5:.*]] = llvm.call @Glass.helper(%[[ARG0]], %[[ARG1]]) : (!llvm.ptr, i32) -> f32
// CHECK-NEXT: llvm.store %[[V5]], %[[V4]] {alignment = 4 : i64} : f32, !llvm.ptr
// CHECK-NEXT: llvm.return
// CHECK-NEXT: }
func.func @Glass.constructor(%self: !rtsl.ref<"Glass">) attributes {rtsl.constructor} {
  %eta = rtsl.member %self["eta"] : !rtsl.ref<"Glass"> -> !rtsl.ptr<f32>
  %r = func.call @Glass.helper(%self) : (!rtsl.ref<"Glass">) -> f32
  rtsl.store %r, %eta : !rtsl.ptr<f32>
  return
}
// CHECK-LABEL: llvm.func @Glass.helper(
// CHECK-SAME: %[[ARG0:.*]]: !llvm.ptr {llvm.align = 8 : i64, llvm.dereferenceable = {{[0-9]+}} : i64, llvm.noalias, llvm.nonnull}, %[[ARG1:.*]]: i32) -> f32 attributes {no_unwind} {
// CHECK-NEXT: %[[V0:.*]] = llvm.load %[[ARG0]] {alignment = 8 : i64} : !llvm.ptr -> !llvm.ptr
// CHECK-NEXT: %[[V1:.*]] = llvm.load %[[V0]] invariant {alignment = 8 : i64} : !llvm.ptr -> !llvm.ptr
// CHECK-NEXT: %[[V2:.*]] = llvm.zext %[[ARG1]] : i32 to i64
// CHECK-NEXT: %[[V3:.*]] = llvm.getelementptr inbounds %[[V1]][%[[V2]]] : (!llvm.ptr, i64) -> !llvm.ptr, !llvm.array<1 x i8>
// CHECK-NEXT: %[[V4:.*]] = llvm.getelementptr inbounds|nuw %[[V3]][16] : (!llvm.ptr) -> !llvm.ptr, i8
// CHECK-NEXT: %[[V5:.*]] = llvm.load %[[V4]] {alignment = 4 : i64} : !llvm.ptr -> f32
// CHECK-NEXT: llvm.return %[[V5]] : f32
// CHECK-NEXT: }
func.func @Glass.helper(%self: !rtsl.ref<"Glass">) -> f32 {
  %eta = rtsl.member %self["eta"] : !rtsl.ref<"Glass"> -> !rtsl.ptr<f32>
  %e = rtsl.load %eta : !rtsl.ptr<f32>
  return %e : f32
}
