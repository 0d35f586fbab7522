// All variables of a function become values at once, as mem2reg makes them one after the other: what is stored and loaded in one block,
// what passes blocks, and arguments of blocks where edges meet. A variable whose address is taken stays.
// RUN: rtsl-opt %s --rtsl-promote-vars --rtsl-simplify | FileCheck %s

// CHECK-LABEL: func.func @inOneBlock(
// CHECK-SAME: %[[X:.*]]: f32
// CHECK-NEXT: return %[[X]]
func.func @inOneBlock(%x: f32) -> f32 {
  %a = rtsl.var "a" : !rtsl.ptr<f32>
  %b = rtsl.var "b" : !rtsl.ptr<f32>
  rtsl.store %x, %a : !rtsl.ptr<f32>
  %1 = rtsl.load %a : !rtsl.ptr<f32>
  rtsl.store %1, %b : !rtsl.ptr<f32>
  %2 = rtsl.load %b : !rtsl.ptr<f32>
  return %2 : f32
}

// What is never stored is zero; a clear makes it so again.
// CHECK-LABEL: func.func @zero(
// CHECK: %[[ZERO:.*]] = arith.constant 0.000000e+00 : f32
// CHECK: return %[[ZERO]], %[[ZERO]]
func.func @zero(%x: f32) -> (f32, f32) {
  %a = rtsl.var "a" : !rtsl.ptr<f32>
  %1 = rtsl.load %a : !rtsl.ptr<f32>
  rtsl.store %x, %a : !rtsl.ptr<f32>
  rtsl.clear %a : !rtsl.ptr<f32>
  %2 = rtsl.load %a : !rtsl.ptr<f32>
  return %1, %2 : f32, f32
}

// A loop: both variables of the loop become arguments of its head, `same` does not.
// CHECK-LABEL: func.func @loop(
// CHECK-SAME: %[[N:.*]]: i32, %[[X:.*]]: f32
// CHECK: cf.br ^[[HEAD:.*]](%{{.*}}, %{{.*}} : i32, f32)
// CHECK: ^[[HEAD]](%[[I:.*]]: i32, %[[SUM:.*]]: f32)
// CHECK: arith.cmpi slt, %[[I]], %[[N]]
// CHECK: %[[MORE:.*]] = arith.addf %[[SUM]], %[[X]]
// CHECK: %[[NEXT:.*]] = arith.addi %[[I]]
// CHECK: cf.br ^[[HEAD]](%[[NEXT]], %[[MORE]] : i32, f32)
// CHECK: return %[[SUM]], %[[X]]
func.func @loop(%n: i32, %x: f32) -> (f32, f32) {
  %zero = arith.constant 0 : i32
  %one = arith.constant 1 : i32
  %i = rtsl.var "i" : !rtsl.ptr<i32>
  %sum = rtsl.var "sum" : !rtsl.ptr<f32>
  %same = rtsl.var "same" : !rtsl.ptr<f32>
  rtsl.store %zero, %i : !rtsl.ptr<i32>
  rtsl.store %x, %same : !rtsl.ptr<f32>
  cf.br ^head
^head:
  %1 = rtsl.load %i : !rtsl.ptr<i32>
  %more = arith.cmpi slt, %1, %n : i32
  cf.cond_br %more, ^body, ^end
^body:
  %2 = rtsl.load %sum : !rtsl.ptr<f32>
  %3 = rtsl.load %same : !rtsl.ptr<f32>
  %4 = arith.addf %2, %3 : f32
  rtsl.store %4, %sum : !rtsl.ptr<f32>
  %5 = rtsl.load %i : !rtsl.ptr<i32>
  %6 = arith.addi %5, %one : i32
  rtsl.store %6, %i : !rtsl.ptr<i32>
  cf.br ^head
^end:
  %7 = rtsl.load %sum : !rtsl.ptr<f32>
  %8 = rtsl.load %same : !rtsl.ptr<f32>
  return %7, %8 : f32, f32
}

// Two variables that change places: what each gives was loaded from the other.
// CHECK-LABEL: func.func @swap(
// CHECK: ^[[HEAD:.*]](%[[A:.*]]: f32, %[[B:.*]]: f32)
// CHECK: cf.cond_br %{{.*}}, ^[[HEAD]](%[[B]], %[[A]] : f32, f32)
func.func @swap(%x: f32, %y: f32, %again: i1) -> f32 {
  %a = rtsl.var "a" : !rtsl.ptr<f32>
  %b = rtsl.var "b" : !rtsl.ptr<f32>
  rtsl.store %x, %a : !rtsl.ptr<f32>
  rtsl.store %y, %b : !rtsl.ptr<f32>
  cf.br ^head
^head:
  %1 = rtsl.load %a : !rtsl.ptr<f32>
  %2 = rtsl.load %b : !rtsl.ptr<f32>
  rtsl.store %2, %a : !rtsl.ptr<f32>
  rtsl.store %1, %b : !rtsl.ptr<f32>
  cf.cond_br %again, ^head, ^end
^end:
  %3 = rtsl.load %a : !rtsl.ptr<f32>
  return %3 : f32
}

// CHECK-LABEL: func.func @addressTaken(
// CHECK: rtsl.var "a"
// CHECK: rtsl.field
func.func @addressTaken(%x: f32) -> f32 {
  %a = rtsl.var "a" : !rtsl.ptr<!rtsl.struct<"P", {x: f32}>>
  %f = rtsl.field %a["x"] : !rtsl.ptr<!rtsl.struct<"P", {x: f32}>> -> !rtsl.ptr<f32>
  rtsl.store %x, %f : !rtsl.ptr<f32>
  %1 = rtsl.load %f : !rtsl.ptr<f32>
  return %1 : f32
}
