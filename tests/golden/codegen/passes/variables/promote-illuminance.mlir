// The loop over the lights; continue and break belong to it.
// RUN: rtsl-opt %s --rtsl-to-cf --rtsl-hoist-vars --mem2reg --canonicalize --cse | FileCheck %s

// CHECK-LABEL: func.func @lights(
// CHECK-SAME: %[[ARG0:.*]]: vector<3xf32>, %[[ARG1:.*]]: vector<3xf32>, %[[ARG2:.*]]: f32) {
// CHECK-NEXT: %[[C1_I32:.*]] = arith.constant 1 : i32
// CHECK-NEXT: %[[C0_I32:.*]] = arith.constant 0 : i32
// CHECK-NEXT: %[[SAMPLECOLOR:.*]] = rtsl.state "SampleColor" : !rtsl.ptr<vector<3xf32>>
// CHECK-NEXT: %[[LIGHTCOLOR:.*]] = rtsl.state "LightColor" : !rtsl.ptr<vector<3xf32>>
// CHECK-NEXT: %[[V0:.*]] = rtsl.light_count
// CHECK-NEXT: cf.br ^bb1(%[[C0_I32]] : i32)
// CHECK-NEXT: ^bb1(%[[V1:.*]]: i32):
// CHECK-NEXT: %[[V2:.*]] = arith.cmpi ult, %[[V1]], %[[V0]] : i32
// CHECK-NEXT: cf.cond_br %[[V2]], ^bb2, ^bb6
// CHECK-NEXT: ^bb2:
// CHECK-NEXT: %[[V3:.*]] = rtsl.illuminate %[[ARG0]] light %[[V1]] normal %[[ARG1]] cos %[[ARG2]]
// CHECK-NEXT: cf.cond_br %[[V3]], ^bb3, ^bb5
// CHECK-NEXT: ^bb3:
// CHECK-NEXT: %[[V4:.*]] = rtsl.load %[[LIGHTCOLOR]] : !rtsl.ptr<vector<3xf32>>
// CHECK-NEXT: %[[V5:.*]] = vector.extract %[[V4]][0] : f32 from vector<3xf32>
// CHECK-NEXT: %[[V6:.*]] = arith.cmpf olt, %[[V5]], %[[ARG2]] : f32
// CHECK-NEXT: cf.cond_br %[[V6]], ^bb5, ^bb4
// CHECK-NEXT: ^bb4:
// CHECK-NEXT: %[[V7:.*]] = rtsl.load %[[SAMPLECOLOR]] : !rtsl.ptr<vector<3xf32>>
// CHECK-NEXT: %[[V8:.*]] = arith.addf %[[V7]], %[[V4]] : vector<3xf32>
// CHECK-NEXT: rtsl.store %[[V8]], %[[SAMPLECOLOR]] : !rtsl.ptr<vector<3xf32>>
// CHECK-NEXT: cf.br ^bb6
// CHECK-NEXT: ^bb5:
// CHECK-NEXT: %[[V9:.*]] = arith.addi %[[V1]], %[[C1_I32]] : i32
// CHECK-NEXT: cf.br ^bb1(%[[V9]] : i32)
// CHECK-NEXT: ^bb6:
// CHECK-NEXT: return
// CHECK-NEXT: }
func.func @lights(%p: vector<3xf32>, %n: vector<3xf32>, %c: f32) {
  %sum = rtsl.state "SampleColor" : !rtsl.ptr<vector<3xf32>>
  %light = rtsl.state "LightColor" : !rtsl.ptr<vector<3xf32>>
  rtsl.illuminance %p normal %n cos %c {
    %l = rtsl.load %light : !rtsl.ptr<vector<3xf32>>
    %x = vector.extract %l[0] : f32 from vector<3xf32>
    %dark = arith.cmpf olt, %x, %c : f32
    rtsl.if %dark {
      rtsl.continue
    }
    %s = rtsl.load %sum : !rtsl.ptr<vector<3xf32>>
    %t = arith.addf %s, %l : vector<3xf32>
    rtsl.store %t, %sum : !rtsl.ptr<vector<3xf32>>
    rtsl.break
  }
  rtsl.return
}
