// Test before the body; break leaves, continue goes to the step.
// RUN: rtsl-opt %s --rtsl-to-cf | FileCheck %s

// CHECK-LABEL: func.func @loop(
// CHECK-SAME: %[[ARG0:.*]]: i1, %[[ARG1:.*]]: i1, %[[ARG2:.*]]: !rtsl.ptr<i1>) {
// CHECK-NEXT: cf.br ^bb1
// CHECK-NEXT: ^bb1:
// CHECK-NEXT: %[[V0:.*]] = rtsl.load %[[ARG2]] : !rtsl.ptr<i1>
// CHECK-NEXT: cf.cond_br %[[V0]], ^bb2, ^bb8
// CHECK-NEXT: ^bb2:
// CHECK-NEXT: cf.cond_br %[[ARG0]], ^bb3, ^bb4
// CHECK-NEXT: ^bb3:
// CHECK-NEXT: cf.br ^bb8
// CHECK-NEXT: ^bb4:
// CHECK-NEXT: cf.cond_br %[[ARG1]], ^bb5, ^bb6
// CHECK-NEXT: ^bb5:
// CHECK-NEXT: cf.br ^bb7
// CHECK-NEXT: ^bb6:
// CHECK-NEXT: rtsl.store %[[ARG0]], %[[ARG2]] : !rtsl.ptr<i1>
// CHECK-NEXT: cf.br ^bb7
// CHECK-NEXT: ^bb7:
// CHECK-NEXT: rtsl.store %[[ARG1]], %[[ARG2]] : !rtsl.ptr<i1>
// CHECK-NEXT: cf.br ^bb1
// CHECK-NEXT: ^bb8:
// CHECK-NEXT: return
// CHECK-NEXT: }
func.func @loop(%a: i1, %b: i1, %p: !rtsl.ptr<i1>) {
  rtsl.loop cond {
    %c = rtsl.load %p : !rtsl.ptr<i1>
    rtsl.condition %c
  } do {
    rtsl.if %a {
      rtsl.break
    }
    rtsl.if %b {
      rtsl.continue
    }
    rtsl.store %a, %p : !rtsl.ptr<i1>
    rtsl.yield
  } step {
    rtsl.store %b, %p : !rtsl.ptr<i1>
    rtsl.yield
  }
  rtsl.return
}
// CHECK-LABEL: func.func @conditionWithChoice(
// CHECK-SAME: %[[ARG0:.*]]: i1, %[[ARG1:.*]]: !rtsl.ptr<i1>) {
// CHECK-NEXT: cf.br ^bb1
// CHECK-NEXT: ^bb1:
// CHECK-NEXT: cf.cond_br %[[ARG0]], ^bb2, ^bb3
// CHECK-NEXT: ^bb2:
// CHECK-NEXT: rtsl.store %[[ARG0]], %[[ARG1]] : !rtsl.ptr<i1>
// CHECK-NEXT: cf.br ^bb3
// CHECK-NEXT: ^bb3:
// CHECK-NEXT: %[[V0:.*]] = rtsl.load %[[ARG1]] : !rtsl.ptr<i1>
// CHECK-NEXT: cf.cond_br %[[V0]], ^bb4, ^bb5
// CHECK-NEXT: ^bb4:
// CHECK-NEXT: cf.br ^bb1
// CHECK-NEXT: ^bb5:
// CHECK-NEXT: return
// CHECK-NEXT: }
func.func @conditionWithChoice(%a: i1, %p: !rtsl.ptr<i1>) {
  rtsl.loop cond {
    rtsl.if %a {
      rtsl.store %a, %p : !rtsl.ptr<i1>
      rtsl.yield
    }
    %c = rtsl.load %p : !rtsl.ptr<i1>
    rtsl.condition %c
  } do {
    rtsl.yield
  }
  rtsl.return
}
// CHECK-LABEL: func.func @switchInLoop(
// CHECK-SAME: %[[ARG0:.*]]: i32) {
// CHECK-NEXT: cf.br ^bb1
// CHECK-NEXT: ^bb1:
// CHECK-NEXT: cf.switch %[[ARG0]] : i32, [
// CHECK-NEXT: default: ^bb4,
// CHECK-NEXT: 1: ^bb2,
// CHECK-NEXT: 2: ^bb3
// CHECK-NEXT: ]
// CHECK-NEXT: ^bb2:
// CHECK-NEXT: cf.br ^bb5
// CHECK-NEXT: ^bb3:
// CHECK-NEXT: cf.br ^bb1
// CHECK-NEXT: ^bb4:
// CHECK-NEXT: return
// CHECK-NEXT: ^bb5:
// CHECK-NEXT: cf.br ^bb6
// CHECK-NEXT: ^bb6:
// CHECK-NEXT: return
// CHECK-NEXT: }
func.func @switchInLoop(%v: i32) {
  rtsl.loop do {
    rtsl.switch %v : i32 {
      arm [1] {
        rtsl.break
      }
      arm [2] {
        rtsl.continue
      }
      arm default {
        rtsl.return
      }
    }
    rtsl.break
  }
  rtsl.return
}

// A condition may return, in a structured op of its own.
// CHECK-LABEL: func.func @conditionReturns(
// CHECK-SAME: %[[ARG0:.*]]: i1, %[[ARG1:.*]]: i1, %[[ARG2:.*]]: !rtsl.ptr<i1>) {
// CHECK-NEXT: cf.br ^bb1
// CHECK-NEXT: ^bb1:
// CHECK-NEXT: cf.cond_br %[[ARG0]], ^bb2, ^bb3
// CHECK-NEXT: ^bb2:
// CHECK-NEXT: return
// CHECK-NEXT: ^bb3:
// CHECK-NEXT: cf.cond_br %[[ARG1]], ^bb4, ^bb5
// CHECK-NEXT: ^bb4:
// CHECK-NEXT: rtsl.store %[[ARG0]], %[[ARG2]] : !rtsl.ptr<i1>
// CHECK-NEXT: cf.br ^bb1
// CHECK-NEXT: ^bb5:
// CHECK-NEXT: return
// CHECK-NEXT: }
func.func @conditionReturns(%a: i1, %b: i1, %p: !rtsl.ptr<i1>) {
  rtsl.loop cond {
    rtsl.if %a {
      rtsl.return
    }
    rtsl.condition %b
  } do {
    rtsl.store %a, %p : !rtsl.ptr<i1>
    rtsl.yield
  }
  rtsl.return
}
