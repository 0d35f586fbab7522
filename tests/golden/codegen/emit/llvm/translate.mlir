// All the way from structured control flow to LLVM IR.
// RUN: rtsl-opt %s --rtsl-ssa --rtsl-llvm | mlir-translate --mlir-to-llvmir | FileCheck %s

// CHECK: declare float @rtsl_exp(float) #[[PURE:[0-9]+]]
// CHECK-LABEL: define float @falloff(ptr noalias nonnull align 8 dereferenceable({{[0-9]+}}) %0, i32 %1, float %2)
// CHECK: phi float [ %{{[0-9]+}}, %{{[0-9]+}} ], [ 1.000000e+00, %3 ]
// CHECK: call float @rtsl_exp(float %{{[0-9]+}})
// CHECK: fmul float
// CHECK: attributes #[[PURE]] = { nounwind willreturn memory(none) }
func.func @falloff(%n: i32, %x: f32) -> f32 attributes {rtsl.export} {
  %one = arith.constant 1 : i32
  %unit = arith.constant 1.0 : f32
  %r = rtsl.var "r" : !rtsl.ptr<f32>
  rtsl.store %unit, %r : !rtsl.ptr<f32>
  %i = rtsl.var "i" : !rtsl.ptr<i32>
  rtsl.loop cond {
    %v = rtsl.load %i : !rtsl.ptr<i32>
    %c = arith.cmpi slt, %v, %n : i32
    rtsl.condition %c
  } do {
    %v = rtsl.load %r : !rtsl.ptr<f32>
    %e = rtsl.elementary <exp> %v : f32
    %m = arith.mulf %e, %x : f32
    rtsl.store %m, %r : !rtsl.ptr<f32>
    rtsl.yield
  } step {
    %v = rtsl.load %i : !rtsl.ptr<i32>
    %w = arith.addi %v, %one : i32
    rtsl.store %w, %i : !rtsl.ptr<i32>
    rtsl.yield
  }
  %v = rtsl.load %r : !rtsl.ptr<f32>
  rtsl.return %v : f32
}
