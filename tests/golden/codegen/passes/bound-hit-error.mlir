// Beside each operation that t depends on stands the same in double; what is read is exact. At the end `hitError` has how far the hit
// at HitDistance is off, -2 if there is no such hit any more, or -1 if one of them has no bound.
// RUN: rtsl-opt %s --rtsl-bound-hit-error --mem2reg --rtsl-simplify | FileCheck %s

// CHECK-LABEL: func.func @Plane.intersect(
// CHECK-DAG: %[[NONE:.*]] = arith.constant -2.000000e+00 : f32
// CHECK-DAG: arith.extf %{{.*}} : f32 to f64
// CHECK: arith.subf %{{.*}}, %{{.*}} : f64
// CHECK: arith.divf %{{.*}}, %{{.*}} : f64
// CHECK-NOT: rtsl.hit
// CHECK: math.absf %{{.*}} : f64
// CHECK: %[[ERROR:.*]] = arith.truncf %{{.*}} : f64 to f32
// CHECK: arith.select %{{.*}}, %[[ERROR]], %[[NONE]] : f32
// CHECK: rtsl.state "hitError"
// CHECK: rtsl.store
func.func @Plane.intersect(%height: f32, %y: f32, %slope: f32) {
  %away = arith.subf %height, %y : f32
  %t = arith.divf %away, %slope : f32
  %h = rtsl.hit %t
  return
}

// What an author states is left to him.
// CHECK-LABEL: func.func @Stated.intersect(
// CHECK-NOT: f64
// CHECK: arith.constant -1.000000e+00 : f32
// CHECK-NOT: f64
// CHECK: return
func.func @Stated.intersect(%x: f32, %e: f32) {
  %h = rtsl.hit %x within %e
  return
}

// The least of several: what flows in is double.
// CHECK-LABEL: func.func @Least.intersect(
// CHECK: cf.br ^[[LOOP:.*]](%{{.*}} : i32, f64)
// CHECK: ^[[LOOP]](%{{.*}}: i32, %{{.*}}: f64)
func.func @Least.intersect(%x: f32, %n: i32) {
  %zero = arith.constant 0 : i32
  %one = arith.constant 1 : i32
  %far = arith.constant 1.0e30 : f32
  cf.br ^loop(%zero, %far : i32, f32)
^loop(%i: i32, %least: f32):
  %more = arith.cmpi slt, %i, %n : i32
  cf.cond_br %more, ^body, ^end
^body:
  %f = arith.sitofp %i : i32 to f32
  %t = arith.addf %x, %f : f32
  %below = arith.cmpf olt, %t, %least : f32
  %newer = arith.select %below, %t, %least : f32
  %next = arith.addi %i, %one : i32
  cf.br ^loop(%next, %newer : i32, f32)
^end:
  %h = rtsl.hit %least
  return
}

// A literal with many digits is off by half a unit, 2^-24 of it; 0.5 is what it is.
// CHECK-LABEL: func.func @Literal.intersect(
// CHECK: %[[ROUNDING:.*]] = arith.constant 1.98{{[0-9]*}}E-8 : f64
// CHECK: %[[X:.*]] = arith.extf %{{.*}} : f32 to f64
// CHECK: %[[SIZE:.*]] = math.absf %[[X]] : f64
// CHECK: %[[ERROR:.*]] = arith.mulf %[[SIZE]], %[[ROUNDING]] : f64
// CHECK: arith.addf %{{.*}}, %[[ERROR]] : f64
func.func @Literal.intersect(%x: f32) {
  %third = arith.constant 0.33333334 : f32
  %half = arith.constant 0.5 : f32
  %part = arith.mulf %x, %third : f32
  %t = arith.addf %part, %half : f32
  %h = rtsl.hit %t
  return
}

// The hit was reported: what it depends on is not asked again.
// CHECK-LABEL: func.func @Condition.intersect(
// CHECK-NOT: cmpf ogt
// CHECK-NOT: cf.cond_br
// CHECK: return
func.func @Condition.intersect(%x: f32, %away: f32) {
  %zero = arith.constant 0.0 : f32
  %square = arith.mulf %x, %x : f32
  %isAway = arith.cmpf ogt, %away, %zero : f32
  cf.cond_br %isAway, ^miss, ^near
^near:
  %h = rtsl.hit %square
  return
^miss:
  return
}

// After a hit, which may have been the one, and in a loop, conditions are asked.
// CHECK-LABEL: func.func @Second.intersect(
// CHECK: cf.cond_br
func.func @Second.intersect(%x: f32, %away: i1) {
  %square = arith.mulf %x, %x : f32
  %first = rtsl.hit %square
  cf.cond_br %away, ^miss, ^again
^again:
  %h = rtsl.hit %x
  return
^miss:
  return
}
// CHECK-LABEL: func.func @Until.intersect(
// CHECK: cf.cond_br
func.func @Until.intersect(%x: f32, %n: i32) {
  %zero = arith.constant 0 : i32
  %one = arith.constant 1 : i32
  cf.br ^loop(%zero : i32)
^loop(%i: i32):
  %more = arith.cmpi slt, %i, %n : i32
  cf.cond_br %more, ^body, ^end
^body:
  %next = arith.addi %i, %one : i32
  %found = arith.cmpi eq, %next, %n : i32
  cf.cond_br %found, ^near, ^loop(%next : i32)
^near:
  %h = rtsl.hit %x
  return
^end:
  return
}

// What is compared is double.
// CHECK-LABEL: func.func @Branch.intersect(
// CHECK: %[[SQUARE:.*]] = arith.mulf %{{.*}}, %{{.*}} : f64
// CHECK: %[[BELOW:.*]] = arith.cmpf olt, %[[SQUARE]], %{{.*}} : f64
// CHECK: cf.cond_br %[[BELOW]]
func.func @Branch.intersect(%x: f32) {
  %one = arith.constant 1.0 : f32
  %square = arith.mulf %x, %x : f32
  %below = arith.cmpf olt, %square, %one : f32
  cf.cond_br %below, ^near, ^far
^near:
  %h = rtsl.hit %square
  return
^far:
  %g = rtsl.hit %one
  return
}

// A cosine is off by half a unit, so that a comparison of it may be in doubt. If the hit is not found, it is decided the other way.
// CHECK-LABEL: func.func @Doubt.intersect(
// CHECK-DAG: %[[FALSE:.*]] = arith.constant false
// CHECK-DAG: %[[TRUE:.*]] = arith.constant true
// CHECK: cf.br ^[[START:.*]](%{{.*}}, %[[FALSE]] : f32, f32, i1)
// CHECK: ^[[START]](%{{.*}}, %[[OTHERWISE:.*]]: i1)
// CHECK: %[[BELOW:.*]] = arith.cmpf olt, %{{.*}}, %{{.*}} : f64
// CHECK: %[[IN_DOUBT:.*]] = arith.cmpf ole, %{{.*}}, %{{.*}} : f64
// CHECK: %[[FLIP:.*]] = arith.andi %[[IN_DOUBT]], %[[OTHERWISE]]
// CHECK: %[[TAKEN:.*]] = arith.xori %[[BELOW]], %[[FLIP]]
// CHECK: cf.cond_br %[[TAKEN]]
// CHECK: cf.cond_br %{{.*}}, ^{{.*}}, ^[[START]](%{{.*}}, %[[TRUE]] : f32, f32, i1)
func.func @Doubt.intersect(%x: f32) {
  %half = arith.constant 0.5 : f32
  %cosine = rtsl.elementary <cos> %x : f32
  %below = arith.cmpf olt, %cosine, %half : f32
  cf.cond_br %below, ^near, ^far
^near:
  %h = rtsl.hit %cosine
  return
^far:
  %g = rtsl.hit %half
  return
}
