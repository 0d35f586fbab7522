// A return out of two loops, a break out of one, an endless loop, and a variable that starts at zero in each round.
// RUN: rtsl-opt %s --rtsl-to-cf | FileCheck %s

// CHECK-LABEL: func.func @find(
// CHECK-SAME: %[[ARG0:.*]]: i32, %[[ARG1:.*]]: f32) -> i32 {
// CHECK-NEXT: %[[C0_I32:.*]] = arith.constant 0 : i32
// CHECK-NEXT: %[[C1_I32:.*]] = arith.constant 1 : i32
// CHECK-NEXT: %[[I:.*]] = rtsl.var "i" : !rtsl.ptr<i32>
// CHECK-NEXT: cf.br ^bb1
// CHECK-NEXT: ^bb1:
// CHECK-NEXT: %[[V0:.*]] = rtsl.load %[[I]] : !rtsl.ptr<i32>
// CHECK-NEXT: %[[V1:.*]] = arith.cmpi slt, %[[V0]], %[[ARG0]] : i32
// CHECK-NEXT: cf.cond_br %[[V1]], ^bb2, ^bb11
// CHECK-NEXT: ^bb2:
// CHECK-NEXT: %[[J:.*]] = rtsl.var "j" : !rtsl.ptr<i32>
// CHECK-NEXT: cf.br ^bb3
// CHECK-NEXT: ^bb3:
// CHECK-NEXT: %[[V2:.*]] = rtsl.rand
// CHECK-NEXT: %[[V3:.*]] = arith.cmpf olt, %[[V2]], %[[ARG1]] : f32
// CHECK-NEXT: cf.cond_br %[[V3]], ^bb4, ^bb5
// CHECK-NEXT: ^bb4:
// CHECK-NEXT: %[[V4:.*]] = rtsl.load %[[I]] : !rtsl.ptr<i32>
// CHECK-NEXT: %[[V5:.*]] = rtsl.load %[[J]] : !rtsl.ptr<i32>
// CHECK-NEXT: %[[V6:.*]] = arith.addi %[[V4]], %[[V5]] : i32
// CHECK-NEXT: return %[[V6]] : i32
// CHECK-NEXT: ^bb5:
// CHECK-NEXT: %[[V7:.*]] = rtsl.load %[[J]] : !rtsl.ptr<i32>
// CHECK-NEXT: %[[V8:.*]] = arith.cmpi eq, %[[V7]], %[[ARG0]] : i32
// CHECK-NEXT: cf.cond_br %[[V8]], ^bb6, ^bb7
// CHECK-NEXT: ^bb6:
// CHECK-NEXT: cf.br ^bb9
// CHECK-NEXT: ^bb7:
// CHECK-NEXT: cf.br ^bb8
// CHECK-NEXT: ^bb8:
// CHECK-NEXT: %[[V9:.*]] = rtsl.load %[[J]] : !rtsl.ptr<i32>
// CHECK-NEXT: %[[V10:.*]] = arith.addi %[[V9]], %[[C1_I32]] : i32
// CHECK-NEXT: rtsl.store %[[V10]], %[[J]] : !rtsl.ptr<i32>
// CHECK-NEXT: cf.br ^bb3
// CHECK-NEXT: ^bb9:
// CHECK-NEXT: cf.br ^bb10
// CHECK-NEXT: ^bb10:
// CHECK-NEXT: %[[V11:.*]] = rtsl.load %[[I]] : !rtsl.ptr<i32>
// CHECK-NEXT: %[[V12:.*]] = arith.addi %[[V11]], %[[C1_I32]] : i32
// CHECK-NEXT: rtsl.store %[[V12]], %[[I]] : !rtsl.ptr<i32>
// CHECK-NEXT: cf.br ^bb1
// CHECK-NEXT: ^bb11:
// CHECK-NEXT: return %[[C0_I32]] : i32
// CHECK-NEXT: }
func.func @find(%n: i32, %x: f32) -> i32 {
  %zero = arith.constant 0 : i32
  %one = arith.constant 1 : i32
  %i = rtsl.var "i" : !rtsl.ptr<i32>
  rtsl.loop cond {
    %v = rtsl.load %i : !rtsl.ptr<i32>
    %c = arith.cmpi slt, %v, %n : i32
    rtsl.condition %c
  } do {
    %j = rtsl.var "j" : !rtsl.ptr<i32>
    rtsl.loop do {
      %r = rtsl.rand
      %hit = arith.cmpf olt, %r, %x : f32
      rtsl.if %hit {
        %vi = rtsl.load %i : !rtsl.ptr<i32>
        %vj = rtsl.load %j : !rtsl.ptr<i32>
        %s = arith.addi %vi, %vj : i32
        rtsl.return %s : i32
      }
      %vj = rtsl.load %j : !rtsl.ptr<i32>
      %last = arith.cmpi eq, %vj, %n : i32
      rtsl.if %last {
        rtsl.break
      }
      rtsl.yield
    } step {
      %vj = rtsl.load %j : !rtsl.ptr<i32>
      %wj = arith.addi %vj, %one : i32
      rtsl.store %wj, %j : !rtsl.ptr<i32>
      rtsl.yield
    }
    rtsl.yield
  } step {
    %v = rtsl.load %i : !rtsl.ptr<i32>
    %w = arith.addi %v, %one : i32
    rtsl.store %w, %i : !rtsl.ptr<i32>
    rtsl.yield
  }
  rtsl.return %zero : i32
}
