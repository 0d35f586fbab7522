// Both regions join after the `if`; a region that ends in a jump does not.
// RUN: rtsl-opt %s --rtsl-to-cf | FileCheck %s

// CHECK-LABEL: func.func @choose(
// CHECK-SAME: %[[ARG0:.*]]: i1, %[[ARG1:.*]]: i1, %[[ARG2:.*]]: !rtsl.ptr<f32>, %[[ARG3:.*]]: f32) -> f32 {
// CHECK-NEXT: cf.cond_br %[[ARG0]], ^bb1, ^bb4
// CHECK-NEXT: ^bb1:
// CHECK-NEXT: cf.cond_br %[[ARG1]], ^bb2, ^bb3
// CHECK-NEXT: ^bb2:
// CHECK-NEXT: return %[[ARG3]] : f32
// CHECK-NEXT: ^bb3:
// CHECK-NEXT: rtsl.store %[[ARG3]], %[[ARG2]] : !rtsl.ptr<f32>
// CHECK-NEXT: cf.br ^bb8
// CHECK-NEXT: ^bb4:
// CHECK-NEXT: cf.cond_br %[[ARG1]], ^bb5, ^bb6
// CHECK-NEXT: ^bb5:
// CHECK-NEXT: cf.br ^bb7
// CHECK-NEXT: ^bb6:
// CHECK-NEXT: return %[[ARG3]] : f32
// CHECK-NEXT: ^bb7:
// CHECK-NEXT: cf.br ^bb8
// CHECK-NEXT: ^bb8:
// CHECK-NEXT: %[[V0:.*]] = rtsl.load %[[ARG2]] : !rtsl.ptr<f32>
// CHECK-NEXT: return %[[V0]] : f32
// CHECK-NEXT: }
func.func @choose(%c: i1, %d: i1, %p: !rtsl.ptr<f32>, %x: f32) -> f32 {
  rtsl.if %c {
    rtsl.if %d {
      rtsl.return %x : f32
    }
    rtsl.store %x, %p : !rtsl.ptr<f32>
    rtsl.yield
  } else {
    rtsl.if %d {
      rtsl.yield
    } else {
      rtsl.return %x : f32
    }
    rtsl.yield
  }
  %r = rtsl.load %p : !rtsl.ptr<f32>
  rtsl.return %r : f32
}
// CHECK-LABEL: func.func @neverBehind(
// CHECK-SAME: %[[ARG0:.*]]: f32) -> f32 {
// CHECK-NEXT: cf.br ^bb1
// CHECK-NEXT: ^bb1:
// CHECK-NEXT: return %[[ARG0]] : f32
// CHECK-NEXT: }
func.func @neverBehind(%x: f32) -> f32 {
  rtsl.loop do {
    rtsl.return %x : f32
  }
  rtsl.return %x : f32
}
