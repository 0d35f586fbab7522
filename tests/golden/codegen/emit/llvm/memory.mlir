// Memory as it lies: alignment 4 everywhere, a bool in 32 bits, offsets from the layout.
// RUN: rtsl-opt %s --rtsl-to-llvm --cse | FileCheck %s

!s = !rtsl.struct<"S", {a: f32, b: vector<3xf32>, c: i1}>

// CHECK-LABEL: llvm.func @A.boolean(
// CHECK-SAME: %[[ARG0:.*]]: !llvm.ptr {llvm.align = 8 : i64, llvm.dereferenceable = {{[0-9]+}} : i64, llvm.noalias, llvm.nonnull}, %[[ARG1:.*]]: !llvm.ptr {llvm.align = 4 : i64, llvm.dereferenceable = 4 : i64, llvm.noalias, llvm.nocapture, llvm.nonnull}) attributes {no_unwind} {
// CHECK-NEXT: %[[V0:.*]] = llvm.load %[[ARG1]] {alignment = 4 : i64} : !llvm.ptr -> i32
// CHECK-NEXT: %[[V1:.*]] = llvm.mlir.constant(0 : i32) : i32
// CHECK-NEXT: %[[V2:.*]] = llvm.icmp "ne" %[[V0]], %[[V1]] : i32
// CHECK-NEXT: %[[V3:.*]] = llvm.zext %[[V2]] : i1 to i32
// CHECK-NEXT: llvm.store %[[V3]], %[[ARG1]] {alignment = 4 : i64} : i32, !llvm.ptr
// CHECK-NEXT: llvm.return
// CHECK-NEXT: }
func.func @A.boolean(%p: !rtsl.ptr<i1>) {
  %b = rtsl.load %p : !rtsl.ptr<i1>
  rtsl.store %b, %p : !rtsl.ptr<i1>
  return
}
// CHECK-LABEL: llvm.func @A.vector(
// CHECK-SAME: %[[ARG0:.*]]: !llvm.ptr {llvm.align = 8 : i64, llvm.dereferenceable = {{[0-9]+}} : i64, llvm.noalias, llvm.nonnull}, %[[ARG1:.*]]: !llvm.ptr {llvm.align = 4 : i64, llvm.dereferenceable = 12 : i64, llvm.noalias, llvm.nocapture, llvm.nonnull}, %[[ARG2:.*]]: !llvm.ptr {llvm.align = 4 : i64, llvm.dereferenceable = 8 : i64, llvm.noalias, llvm.nocapture, llvm.nonnull}) attributes {no_unwind} {
// CHECK-NEXT: %[[V0:.*]] = llvm.load %[[ARG1]] {alignment = 4 : i64} : !llvm.ptr -> vector<3xf32>
// CHECK-NEXT: llvm.store %[[V0]], %[[ARG1]] {alignment = 4 : i64} : vector<3xf32>, !llvm.ptr
// CHECK-NEXT: %[[V1:.*]] = llvm.load %[[ARG2]] {alignment = 4 : i64} : !llvm.ptr -> vector<2xi32>
// CHECK-NEXT: %[[V2:.*]] = llvm.mlir.constant(dense<0> : vector<2xi32>) : vector<2xi32>
// CHECK-NEXT: %[[V3:.*]] = llvm.icmp "ne" %[[V1]], %[[V2]] : vector<2xi32>
// CHECK-NEXT: %[[V4:.*]] = llvm.zext %[[V3]] : vector<2xi1> to vector<2xi32>
// CHECK-NEXT: llvm.store %[[V4]], %[[ARG2]] {alignment = 4 : i64} : vector<2xi32>, !llvm.ptr
// CHECK-NEXT: llvm.return
// CHECK-NEXT: }
func.func @A.vector(%p: !rtsl.ptr<vector<3xf32>>, %q: !rtsl.ptr<vector<2xi1>>) {
  %v = rtsl.load %p : !rtsl.ptr<vector<3xf32>>
  rtsl.store %v, %p : !rtsl.ptr<vector<3xf32>>
  %b = rtsl.load %q : !rtsl.ptr<vector<2xi1>>
  rtsl.store %b, %q : !rtsl.ptr<vector<2xi1>>
  return
}
// CHECK-LABEL: llvm.func @A.parts(
// CHECK-SAME: %[[ARG0:.*]]: !llvm.ptr {llvm.align = 8 : i64, llvm.dereferenceable = {{[0-9]+}} : i64, llvm.noalias, llvm.nonnull}, %[[ARG1:.*]]: !llvm.ptr {llvm.align = 4 : i64, llvm.dereferenceable = 20 : i64, llvm.noalias, llvm.nocapture, llvm.nonnull}, %[[ARG2:.*]]: !llvm.ptr {llvm.align = 4 : i64, llvm.dereferenceable = 48 : i64, llvm.noalias, llvm.nocapture, llvm.nonnull}, %[[ARG3:.*]]: i32) -> f32 attributes {no_unwind} {
// CHECK-NEXT: %[[V0:.*]] = llvm.getelementptr inbounds|nuw %[[ARG1]][16] : (!llvm.ptr) -> !llvm.ptr, i8
// CHECK-NEXT: %[[V1:.*]] = llvm.load %[[V0]] {alignment = 4 : i64} : !llvm.ptr -> i32
// CHECK-NEXT: %[[V2:.*]] = llvm.mlir.constant(0 : i32) : i32
// CHECK-NEXT: %[[V3:.*]] = llvm.zext %[[ARG3]] : i32 to i64
// CHECK-NEXT: %[[V4:.*]] = llvm.getelementptr inbounds %[[ARG2]][%[[V3]]] : (!llvm.ptr, i64) -> !llvm.ptr, !llvm.array<12 x i8>
// CHECK-NEXT: %[[V5:.*]] = llvm.load %[[V4]] {alignment = 4 : i64} : !llvm.ptr -> vector<3xf32>
// CHECK-NEXT: %[[V6:.*]] = llvm.mlir.constant(1 : i64) : i64
// CHECK-NEXT: %[[V7:.*]] = llvm.extractelement %[[V5]][%[[V6]] : i64] : vector<3xf32>
// CHECK-NEXT: llvm.return %[[V7]] : f32
// CHECK-NEXT: }
func.func @A.parts(%p: !rtsl.ptr<!s>, %a: !rtsl.ptr<!rtsl.array<4 x vector<3xf32>>>, %i: i32) -> f32 {
  %c = rtsl.field %p["c"] : !rtsl.ptr<!s> -> !rtsl.ptr<i1>
  %t = rtsl.load %c : !rtsl.ptr<i1>
  %e = rtsl.element %a[%i] : !rtsl.ptr<!rtsl.array<4 x vector<3xf32>>> -> !rtsl.ptr<vector<3xf32>>
  %v = rtsl.load %e : !rtsl.ptr<vector<3xf32>>
  %x = vector.extract %v[1] : f32 from vector<3xf32>
  %y = arith.select %t, %x, %x : f32
  return %y : f32
}
// CHECK-LABEL: llvm.func @A.variable(
// CHECK-SAME: %[[ARG0:.*]]: !llvm.ptr {llvm.align = 8 : i64, llvm.dereferenceable = {{[0-9]+}} : i64, llvm.noalias, llvm.nonnull}, %[[ARG1:.*]]: i32) -> f32 attributes {no_unwind} {
// CHECK-NEXT: %[[V0:.*]] = llvm.mlir.constant(1 : i32) : i32
// CHECK-NEXT: %[[V1:.*]] = llvm.alloca %[[V0]] x !llvm.array<16 x i8> {alignment = 4 : i64} : (i32) -> !llvm.ptr
// CHECK-NEXT: %[[V2:.*]] = llvm.mlir.constant(0 : i8) : i8
// CHECK-NEXT: %[[V3:.*]] = llvm.mlir.constant(16 : i64) : i64
// CHECK-NEXT: "llvm.intr.memset"(%[[V1]], %[[V2]], %[[V3]]) <{isVolatile = false}> : (!llvm.ptr, i8, i64) -> ()
// CHECK-NEXT: %[[V4:.*]] = llvm.zext %[[ARG1]] : i32 to i64
// CHECK-NEXT: %[[V5:.*]] = llvm.getelementptr inbounds %[[V1]][%[[V4]]] : (!llvm.ptr, i64) -> !llvm.ptr, !llvm.array<4 x i8>
// CHECK-NEXT: %[[V6:.*]] = llvm.load %[[V5]] {alignment = 4 : i64} : !llvm.ptr -> f32
// CHECK-NEXT: llvm.return %[[V6]] : f32
// CHECK-NEXT: }
func.func @A.variable(%i: i32) -> f32 {
  %a = rtsl.var "a" : !rtsl.ptr<!rtsl.array<4 x f32>>
  %e = rtsl.element %a[%i] : !rtsl.ptr<!rtsl.array<4 x f32>> -> !rtsl.ptr<f32>
  %v = rtsl.load %e : !rtsl.ptr<f32>
  return %v : f32
}
// CHECK-LABEL: llvm.func @A.whole(
// CHECK-SAME: %[[ARG0:.*]]: !llvm.ptr {llvm.align = 8 : i64, llvm.dereferenceable = {{[0-9]+}} : i64, llvm.noalias, llvm.nonnull}, %[[ARG1:.*]]: !llvm.ptr {llvm.align = 4 : i64, llvm.dereferenceable = 20 : i64, llvm.noalias, llvm.nocapture, llvm.nonnull}, %[[ARG2:.*]]: !llvm.ptr {llvm.align = 4 : i64, llvm.dereferenceable = 20 : i64, llvm.noalias, llvm.nocapture, llvm.nonnull}) attributes {no_unwind} {
// CHECK-NEXT: %[[V0:.*]] = llvm.mlir.constant(20 : i64) : i64
// CHECK-NEXT: "llvm.intr.memcpy"(%[[ARG2]], %[[ARG1]], %[[V0]]) <{isVolatile = false}> : (!llvm.ptr, !llvm.ptr, i64) -> ()
// CHECK-NEXT: %[[V1:.*]] = llvm.mlir.constant(0 : i8) : i8
// CHECK-NEXT: "llvm.intr.memset"(%[[ARG1]], %[[V1]], %[[V0]]) <{isVolatile = false}> : (!llvm.ptr, i8, i64) -> ()
// CHECK-NEXT: llvm.return
// CHECK-NEXT: }
func.func @A.whole(%p: !rtsl.ptr<!s>, %q: !rtsl.ptr<!s>) {
  rtsl.copy %p to %q : !rtsl.ptr<!s>
  rtsl.clear %p : !rtsl.ptr<!s>
  return
}
