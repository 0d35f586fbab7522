// Calls of the runtime pass scalars and pointers. Offsets in the state are not written down here: they are Abi.h's.
// RUN: rtsl-opt %s --rtsl-to-llvm --cse | FileCheck %s

// CHECK-DAG: llvm.func @rtsl_trace(!llvm.ptr, f32, f32, f32, f32, f32, f32, !llvm.ptr) attributes {no_unwind}
// CHECK-DAG: llvm.func @rtsl_hit(!llvm.ptr, f32) -> i32 attributes {no_unwind}
// CHECK-DAG: llvm.func @rtsl_rand(!llvm.ptr) -> f32 attributes {no_unwind}
// CHECK-DAG: llvm.func @rtsl_illuminance(!llvm.ptr, i32, f32, f32, f32, f32, f32, f32, f32) -> i32 attributes {no_unwind}

// CHECK-LABEL: llvm.func @A.trace(
// CHECK-SAME: %[[STATE:.*]]: !llvm.ptr {llvm.align = 8 : i64, llvm.dereferenceable = {{[0-9]+}} : i64, llvm.noalias, llvm.nonnull}, %[[P:.*]]: vector<3xf32>
// CHECK: %[[COLOR:.*]] = llvm.alloca %{{.*}} x !llvm.array<64 x i8>
// CHECK: %[[X:.*]] = llvm.extractelement %[[P]]
// CHECK: %[[Y:.*]] = llvm.extractelement %[[P]]
// CHECK: %[[Z:.*]] = llvm.extractelement %[[P]]
// CHECK: llvm.call @rtsl_trace(%[[STATE]], %[[X]], %[[Y]], %[[Z]], %[[X]], %[[Y]], %[[Z]], %[[COLOR]])
// CHECK: llvm.load %[[COLOR]] {alignment = 4 : i64} : !llvm.ptr -> vector<4xf32>
func.func @A.trace(%p: vector<3xf32>) -> vector<4xf32> {
  %c = rtsl.trace %p, %p : vector<4xf32>
  return %c : vector<4xf32>
}
// CHECK-LABEL: llvm.func @A.hit(
// CHECK: %[[R:.*]] = llvm.call @rtsl_hit(
// CHECK: llvm.icmp "ne" %[[R]]
func.func @A.hit(%t: f32) -> i1 {
  %h = rtsl.hit %t
  return %h : i1
}
// CHECK-LABEL: llvm.func @A.hit_within(
// CHECK: llvm.call @rtsl_hit_within(%{{.*}}, %{{.*}}, %{{.*}}) : (!llvm.ptr, f32, f32) -> i32
func.func @A.hit_within(%t: f32, %e: f32) -> i1 {
  %h = rtsl.hit %t within %e
  return %h : i1
}
// CHECK-LABEL: llvm.func @A.rand(
// CHECK-SAME: %[[STATE:.*]]: !llvm.ptr {
// CHECK: llvm.call @rtsl_rand(%[[STATE]])
func.func @A.rand() -> f32 {
  %r = rtsl.rand
  return %r : f32
}
// CHECK-LABEL: llvm.func @A.launch(
// CHECK-SAME: %[[STATE:.*]]: !llvm.ptr {
// CHECK: %[[LAUNCH:.*]] = llvm.load %[[STATE]] {alignment = 8
// CHECK: llvm.getelementptr inbounds|nuw %[[LAUNCH]]
// CHECK: llvm.load %{{.*}} invariant {alignment = 4 : i64} : !llvm.ptr -> vector<3xf32>
// CHECK: llvm.load %{{.*}} invariant {alignment = 4 : i64} : !llvm.ptr -> i32
func.func @A.launch() -> (vector<3xf32>) {
  %a = rtsl.ambient : vector<3xf32>
  %n = rtsl.light_count
  %s = arith.sitofp %n : i32 to f32
  %v = vector.broadcast %s : f32 to vector<3xf32>
  %r = arith.addf %a, %v : vector<3xf32>
  return %r : vector<3xf32>
}
// CHECK-LABEL: llvm.func @A.illuminate(
// CHECK-DAG: %[[NONE:.*]] = llvm.mlir.constant(-2.000000e+00 : f32)
// CHECK-DAG: %[[ZERO:.*]] = llvm.mlir.constant(0.000000e+00 : f32)
// CHECK: llvm.call @rtsl_illuminance(%{{.*}}, %{{.*}}, %{{.*}}, %{{.*}}, %{{.*}}, %[[ZERO]], %[[ZERO]], %[[ZERO]], %[[NONE]])
func.func @A.illuminate(%i: i32, %p: vector<3xf32>) -> i1 {
  %l = rtsl.illuminate %p light %i
  return %l : i1
}
// CHECK-LABEL: llvm.func @A.state(
// CHECK-SAME: %[[STATE:.*]]: !llvm.ptr {
// CHECK: %[[P:.*]] = llvm.getelementptr inbounds|nuw %[[STATE]]
// CHECK: llvm.load %[[P]] {alignment = 4 : i64} : !llvm.ptr -> vector<3xf32>
// CHECK: %[[A:.*]] = llvm.getelementptr inbounds|nuw %[[STATE]]
// CHECK: llvm.store %{{.*}}, %[[A]] {alignment = 4 : i64} : vector<3xf32>
func.func @A.state() {
  %p = rtsl.state "HitPoint" : !rtsl.ptr<vector<3xf32>>
  %v = rtsl.load %p : !rtsl.ptr<vector<3xf32>>
  %a = rtsl.attribute "n" {offset = 2 : i32} : !rtsl.ptr<vector<3xf32>>
  rtsl.store %v, %a : !rtsl.ptr<vector<3xf32>>
  return
}
