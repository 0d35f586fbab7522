// A return out of two loops, a break out of one, an endless loop, and a variable that starts at zero in each round.
// RUN: rtsl-opt %s --rtsl-to-cf --rtsl-hoist-vars --mem2reg --canonicalize --cse | FileCheck %s

// CHECK-LABEL: func.func @find(
// CHECK-SAME: %[[ARG0:.*]]: i32, %[[ARG1:.*]]: f32) -> i32 {
// CHECK-NEXT: %[[C0_I32:.*]] = arith.constant 0 : i32
// CHECK-NEXT: %[[C1_I32:.*]] = arith.constant 1 : i32
// CHECK-NEXT: cf.br ^bb1(%[[C0_I32]] : i32)
// CHECK-NEXT: ^bb1(%[[V0:.*]]: i32):
// CHECK-NEXT: %[[V1:.*]] = arith.cmpi slt, %[[V0]], %[[ARG0]] : i32
// CHECK-NEXT: cf.cond_br %[[V1]], ^bb2(%[[C0_I32]] : i32), ^bb7
// CHECK-NEXT: ^bb2(%[[V2:.*]]: i32):
// CHECK-NEXT: %[[V3:.*]] = rtsl.rand
// CHECK-NEXT: %[[V4:.*]] = arith.cmpf olt, %[[V3]], %[[ARG1]] : f32
// CHECK-NEXT: cf.cond_br %[[V4]], ^bb3, ^bb4
// CHECK-NEXT: ^bb3:
// CHECK-NEXT: %[[V5:.*]] = arith.addi %[[V0]], %[[V2]] : i32
// CHECK-NEXT: return %[[V5]] : i32
// CHECK-NEXT: ^bb4:
// CHECK-NEXT: %[[V6:.*]] = arith.cmpi eq, %[[V2]], %[[ARG0]] : i32
// CHECK-NEXT: cf.cond_br %[[V6]], ^bb6, ^bb5
// CHECK-NEXT: ^bb5:
// CHECK-NEXT: %[[V7:.*]] = arith.addi %[[V2]], %[[C1_I32]] : i32
// CHECK-NEXT: cf.br ^bb2(%[[V7]] : i32)
// CHECK-NEXT: ^bb6:
// CHECK-NEXT: %[[V8:.*]] = arith.addi %[[V0]], %[[C1_I32]] : i32
// CHECK-NEXT: cf.br ^bb1(%[[V8]] : i32)
// CHECK-NEXT: ^bb7:
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
