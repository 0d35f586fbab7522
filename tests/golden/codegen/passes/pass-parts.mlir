// RUN: rtsl-opt %s --rtsl-share-calls | FileCheck %s
// An aggregate that a function only reads is passed by its parts.

!point = !rtsl.struct<"Point", {base: vector<3xf32>, alpha: !rtsl.array<2 x f32>}>

// CHECK-LABEL: func.func private @second
// CHECK-SAME:      (%[[X:.*]]: f32, %[[PART:.*]]: f32) -> f32
// CHECK:         arith.addf %[[X]], %[[PART]]
func.func private @second(%point: !rtsl.ptr<!point>, %x: f32) -> f32 {
  %one = arith.constant 1 : i32
  %alpha = rtsl.field %point["alpha"] : !rtsl.ptr<!point> -> !rtsl.ptr<!rtsl.array<2 x f32>>
  %part = rtsl.element %alpha[%one] : !rtsl.ptr<!rtsl.array<2 x f32>> -> !rtsl.ptr<f32>
  %a = rtsl.load %part : !rtsl.ptr<f32>
  %sum = arith.addf %x, %a : f32
  return %sum : f32
}

// Which part is read is not known.
// CHECK-LABEL: func.func private @any
// CHECK-SAME:      (%{{.*}}: !rtsl.ptr<
func.func private @any(%point: !rtsl.ptr<!point>, %i: i32) -> f32 {
  %alpha = rtsl.field %point["alpha"] : !rtsl.ptr<!point> -> !rtsl.ptr<!rtsl.array<2 x f32>>
  %part = rtsl.element %alpha[%i] : !rtsl.ptr<!rtsl.array<2 x f32>> -> !rtsl.ptr<f32>
  %a = rtsl.load %part : !rtsl.ptr<f32>
  return %a : f32
}

// It is written, too.
// CHECK-LABEL: func.func private @changed
// CHECK-SAME:      (%{{.*}}: !rtsl.ptr<
func.func private @changed(%point: !rtsl.ptr<!point>) -> f32 {
  %one = arith.constant 1.0 : f32
  %zero = arith.constant 0 : i32
  %alpha = rtsl.field %point["alpha"] : !rtsl.ptr<!point> -> !rtsl.ptr<!rtsl.array<2 x f32>>
  %part = rtsl.element %alpha[%zero] : !rtsl.ptr<!rtsl.array<2 x f32>> -> !rtsl.ptr<f32>
  rtsl.store %one, %part : !rtsl.ptr<f32>
  %a = rtsl.load %part : !rtsl.ptr<f32>
  return %a : f32
}

// CHECK-LABEL: func.func @caller
// CHECK:         %[[A:.*]] = rtsl.load
// CHECK:         call @second(%{{.*}}, %[[A]]) : (f32, f32) -> f32
func.func @caller(%point: !rtsl.ptr<!point>, %x: f32, %i: i32) -> f32 {
  %a = call @second(%point, %x) : (!rtsl.ptr<!point>, f32) -> f32
  %b = call @any(%point, %i) : (!rtsl.ptr<!point>, i32) -> f32
  %c = call @changed(%point) : (!rtsl.ptr<!point>) -> f32
  %ab = arith.addf %a, %b : f32
  %abc = arith.addf %ab, %c : f32
  return %abc : f32
}
