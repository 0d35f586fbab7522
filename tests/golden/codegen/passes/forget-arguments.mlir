// RUN: rtsl-opt %s --rtsl-forget-arguments | FileCheck %s
// Arguments that no callee uses, also of callees in turn, are not computed.

// CHECK-LABEL: func.func private @inner
func.func private @inner(%value: f32, %change: f32) -> f32 {
  return %value : f32
}

// CHECK-LABEL: func.func private @outer
// CHECK-NOT:     rtsl.state
// CHECK:         %[[ZERO:.*]] = arith.constant 0.0{{.*}} : f32
// CHECK:         call @inner(%{{.*}}, %[[ZERO]])
func.func private @outer(%value: f32, %change: f32) -> f32 {
  %double = arith.addf %change, %change : f32
  %result = call @inner(%value, %double) : (f32, f32) -> f32
  return %result : f32
}

// CHECK-LABEL: func.func @shade
// CHECK-NOT:     ConeWidth
// CHECK:         rtsl.state "HitDistance"
// CHECK-NOT:     ConeWidth
func.func @shade() -> f32 {
  %width = rtsl.state "ConeWidth" : !rtsl.ptr<f32>
  %change = rtsl.load %width : !rtsl.ptr<f32>
  %distance = rtsl.state "HitDistance" : !rtsl.ptr<f32>
  %value = rtsl.load %distance : !rtsl.ptr<f32>
  %square = arith.mulf %change, %change : f32
  %twice = arith.addf %square, %square : f32
  %sum = arith.addf %twice, %square : f32
  %result = call @outer(%value, %sum) : (f32, f32) -> f32
  return %result : f32
}
