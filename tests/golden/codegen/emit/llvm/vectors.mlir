// Vectors of 1 to 16 components and everything that lowering does with them.
// RUN: rtsl-opt %s --rtsl-to-llvm --cse | FileCheck %s

// CHECK-LABEL: llvm.func @A.build(
// CHECK: llvm.insertelement
// CHECK: llvm.insertelement
// CHECK: llvm.shufflevector %{{.*}}, %{{.*}} [1, 0, 1] : vector<2xf32>
func.func @A.build(%x: f32, %y: f32) -> vector<3xf32> {
  %v = vector.from_elements %x, %y : vector<2xf32>
  %s = vector.shuffle %v, %v [1, 0, 1] : vector<2xf32>, vector<2xf32>
  return %s : vector<3xf32>
}
// CHECK-LABEL: llvm.func @A.dynamic(
// CHECK: llvm.zext %{{.*}} : i32 to i64
// CHECK: llvm.extractelement %{{.*}}[%{{.*}} : i64] : vector<4xf32>
// CHECK: llvm.insertelement %{{.*}}, %{{.*}}[%{{.*}} : i64] : vector<4xf32>
func.func @A.dynamic(%v: vector<4xf32>, %i: i32) -> vector<4xf32> {
  %n = arith.index_castui %i : i32 to index
  %x = vector.extract %v[%n] : f32 from vector<4xf32>
  %w = vector.insert %x, %v[%n] : f32 into vector<4xf32>
  return %w : vector<4xf32>
}
// CHECK-LABEL: llvm.func @A.one(
// CHECK: llvm.fmul %{{.*}}, %{{.*}} : vector<1xf32>
func.func @A.one(%v: vector<1xf32>, %x: f32) -> vector<1xf32> {
  %b = vector.broadcast %x : f32 to vector<1xf32>
  %m = arith.mulf %v, %b : vector<1xf32>
  return %m : vector<1xf32>
}
// CHECK-LABEL: llvm.func @A.math(
// CHECK: llvm.intr.sqrt(%{{.*}}) : (vector<16xf32>)
// CHECK: llvm.intr.fma(
// CHECK: llvm.intr.floor(
// CHECK: llvm.intr.fabs(
// CHECK: llvm.fcmp "olt"
// CHECK: llvm.select
func.func @A.math(%v: vector<16xf32>) -> vector<16xf32> {
  %s = math.sqrt %v : vector<16xf32>
  %f = math.fma %s, %v, %s : vector<16xf32>
  %g = math.floor %f : vector<16xf32>
  %h = math.absf %g : vector<16xf32>
  %c = arith.cmpf olt, %h, %v : vector<16xf32>
  %r = arith.select %c, %h, %v : vector<16xi1>, vector<16xf32>
  return %r : vector<16xf32>
}
// CHECK-LABEL: llvm.func @A.wide(
// CHECK: llvm.sext %{{.*}} : vector<2xi32> to vector<2xi64>
// CHECK: llvm.mul %{{.*}} : vector<2xi64>
func.func @A.wide(%a: vector<2xi32>, %b: vector<2xi32>) -> vector<2xi32> {
  %low, %high = arith.mulsi_extended %a, %b : vector<2xi32>
  %s = arith.addi %low, %high : vector<2xi32>
  return %s : vector<2xi32>
}
