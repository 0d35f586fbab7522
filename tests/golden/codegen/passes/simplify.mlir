// RUN: rtsl-opt %s --rtsl-simplify | FileCheck %s

// A loop that is never entered is removed before its body is folded.
// CHECK-LABEL: func.func @deadLoop
// CHECK-NEXT:   return %arg0
func.func @deadLoop(%n: i32) -> i32 {
  %false = arith.constant false
  %one = arith.constant 1 : i32
  cf.cond_br %false, ^loop(%one, %n : i32, i32), ^end(%n : i32)
^loop(%i: i32, %j: i32):
  %next = arith.addi %i, %one : i32
  %more = arith.cmpi slt, %next, %j : i32
  cf.cond_br %more, ^again, ^end(%j : i32)
^again:
  cf.br ^loop(%next, %i : i32, i32)
^end(%r: i32):
  return %r : i32
}

// Blocks that only lead on are skipped, and a value that is the same on both ways is passed on none.
// CHECK-LABEL: func.func @through
// CHECK-NEXT:   cf.cond_br %arg0, ^bb1(%arg1 : i32), ^bb1(%arg2 : i32)
// CHECK-NEXT: ^bb1(%[[V:.*]]: i32):
// CHECK-NEXT:   %[[S:.*]] = arith.addi %[[V]], %arg1
// CHECK-NEXT:   return %[[S]]
func.func @through(%p: i1, %a: i32, %b: i32) -> i32 {
  cf.cond_br %p, ^left, ^right
^left:
  cf.br ^end(%a, %a : i32, i32)
^right:
  cf.br ^end(%b, %a : i32, i32)
^end(%v: i32, %w: i32):
  %s = arith.addi %v, %w : i32
  return %s : i32
}

// A switch on a constant goes one way.
// CHECK-LABEL: func.func @choice
// CHECK-NEXT:   return %arg1
func.func @choice(%a: i32, %b: i32) -> i32 {
  %two = arith.constant 2 : i32
  cf.switch %two : i32, [default: ^end(%a : i32), 1: ^end(%a : i32), 2: ^end(%b : i32)]
^end(%r: i32):
  return %r : i32
}

// MLIR leaves math.fma of constants alone. (1 + 2^-23)^2 - (1 + 2^-22) is 2^-46 in one rounding, 0 in two.
// CHECK-LABEL: func.func @fusedConstants
// CHECK-DAG:     %[[SCALAR:.*]] = arith.constant 1.42108547E-14 : f32
// CHECK-DAG:     %[[VECTOR:.*]] = arith.constant dense<[7.000000e+00, 1.000000e+00]> : vector<2xf32>
// CHECK:         return %[[SCALAR]], %[[VECTOR]]
func.func @fusedConstants() -> (f32, vector<2xf32>) {
  %near = arith.constant 1.00000012 : f32
  %less = arith.constant -1.00000024 : f32
  %scalar = math.fma %near, %near, %less : f32
  %a = arith.constant dense<[2.0, 3.0]> : vector<2xf32>
  %b = arith.constant dense<[3.0, 0.0]> : vector<2xf32>
  %c = arith.constant dense<1.0> : vector<2xf32>
  %vector = math.fma %a, %b, %c : vector<2xf32>
  return %scalar, %vector : f32, vector<2xf32>
}
