// Small functions are inlined, and removed if private; functions marked `rtsl.noinline` stay.
// RUN: rtsl-opt %s --rtsl-inline | FileCheck %s

// CHECK-LABEL: func.func @caller(
// CHECK-SAME: %[[ARG0:.*]]: f32, %[[ARG1:.*]]: !rtsl.ref<"A">) -> f32 {
// CHECK-NEXT: %[[V0:.*]] = arith.addf %[[ARG0]], %[[ARG0]] : f32
// CHECK-NEXT: %[[V1:.*]] = call @kept(%[[V0]]) : (f32) -> f32
// CHECK-NEXT: %[[V2:.*]] = call @down(%[[V1]]) : (f32) -> f32
// CHECK-NEXT: call @A.constructor(%[[ARG1]]) : (!rtsl.ref<"A">) -> ()
// CHECK-NEXT: return %[[V2]] : f32
// CHECK-NEXT: }
func.func @caller(%x: f32, %self: !rtsl.ref<"A">) -> f32 {
  %a = func.call @twice(%x) : (f32) -> f32
  %b = func.call @kept(%a) : (f32) -> f32
  %c = func.call @down(%b) : (f32) -> f32
  func.call @A.constructor(%self) : (!rtsl.ref<"A">) -> ()
  return %c : f32
}
// CHECK-NOT: @twice(
func.func private @twice(%x: f32) -> f32 {
  %y = arith.addf %x, %x : f32
  return %y : f32
}
// CHECK-LABEL: func.func private @kept(
// CHECK-SAME: %[[ARG0:.*]]: f32) -> f32 attributes {rtsl.noinline} {
// CHECK-NEXT: return %[[ARG0]] : f32
// CHECK-NEXT: }
func.func private @kept(%x: f32) -> f32 attributes {rtsl.noinline} {
  return %x : f32
}
// CHECK-LABEL: func.func private @down(
// CHECK-SAME: %[[ARG0:.*]]: f32) -> f32 {
// CHECK-NEXT: %[[V0:.*]] = call @down(%[[ARG0]]) : (f32) -> f32
// CHECK-NEXT: return %[[V0]] : f32
// CHECK-NEXT: }
func.func private @down(%x: f32) -> f32 {
  %y = func.call @down(%x) : (f32) -> f32
  return %y : f32
}
// CHECK-LABEL: func.func private @A.constructor(
// CHECK-SAME: %[[ARG0:.*]]: !rtsl.ref<"A">) attributes {rtsl.constructor} {
// CHECK-NEXT: return
// CHECK-NEXT: }
func.func private @A.constructor(%self: !rtsl.ref<"A">) attributes {rtsl.constructor} {
  return
}
