// Blocks and branches back to structured control flow, with the author's names on variables.
// RUN: rtsl-opt %s --rtsl-restructure --split-input-file | FileCheck %s
// What comes out is level 1: it goes back to level 2, and there and back again it does not change any more.
// RUN: rtsl-opt %s --rtsl-restructure --rtsl-to-cf --rtsl-restructure --split-input-file | FileCheck %s --check-prefix=AGAIN
// AGAIN-NOT: cf.
// AGAIN: rtsl.if
// AGAIN-NOT: cf.

// A choice, and a variable that both arms set.
// CHECK-LABEL: @choice(
// CHECK: %[[W:.*]] = rtsl.var "weight" : !rtsl.ptr<f32>
// CHECK: rtsl.if %{{.*}} {
// CHECK-NEXT:   rtsl.store %{{.*}}, %[[W]]
// CHECK-NEXT:   rtsl.yield
// CHECK-NEXT: } else {
// CHECK-NEXT:   %[[N:.*]] = arith.negf
// CHECK-NEXT:   rtsl.store %[[N]], %[[W]]
// CHECK-NEXT:   rtsl.yield
// CHECK-NEXT: }
// CHECK-NEXT: %[[R:.*]] = rtsl.load %[[W]]
// CHECK-NEXT: rtsl.return %[[R]] : f32
func.func @choice(%c: i1, %x: f32) -> f32 {
  cf.cond_br %c, ^join(%x : f32), ^other
^other:
  %n = arith.negf %x : f32
  cf.br ^join(%n : f32)
^join(%w: f32 loc("weight")):
  return %w : f32
}

// -----

// The same in double precision, as in bounds of errors.
// CHECK-LABEL: @choiceOfDoubles(
// CHECK: %[[W:.*]] = rtsl.var "merged" : !rtsl.ptr<vector<3xf64>>
// CHECK: rtsl.store %{{.*}}, %[[W]]
// CHECK: %[[R:.*]] = rtsl.load %[[W]]
// CHECK-NEXT: rtsl.return %[[R]] : vector<3xf64>
func.func @choiceOfDoubles(%c: i1, %x: vector<3xf64>) -> vector<3xf64> {
  cf.cond_br %c, ^join(%x : vector<3xf64>), ^other
^other:
  %n = arith.negf %x : vector<3xf64>
  cf.br ^join(%n : vector<3xf64>)
^join(%w: vector<3xf64>):
  return %w : vector<3xf64>
}

// -----

// Nested loops: `while` both, each variable is stored where it changes.
// CHECK-LABEL: @nested(
// CHECK: %[[J:.*]] = rtsl.var "j"
// CHECK: rtsl.loop cond {
// CHECK:   %[[OLD:.*]] = rtsl.load %[[J]]
// CHECK:   arith.cmpi slt, %[[OLD]], %{{.*}}
// CHECK:   rtsl.condition
// CHECK: } do {
// CHECK:   %[[I:.*]] = rtsl.var "i"
// CHECK:   rtsl.loop cond {
// CHECK:     rtsl.load %[[I]]
// CHECK:     rtsl.condition
// CHECK:   } do {
// CHECK:     %[[NEXT:.*]] = arith.addi
// CHECK-NEXT: rtsl.store %[[NEXT]], %[[I]]
// CHECK-NEXT: rtsl.yield
// CHECK:   }
// CHECK:   rtsl.store %{{.*}}, %[[J]]
// CHECK-NEXT: rtsl.yield
// CHECK: }
// CHECK: rtsl.return
func.func @nested(%n: i32) -> i32 {
  %zero = arith.constant 0 : i32
  %one = arith.constant 1 : i32
  cf.br ^outer(%zero : i32)
^outer(%j: i32 loc("j")):
  %more = arith.cmpi slt, %j, %n : i32
  cf.cond_br %more, ^inner(%zero : i32), ^done
^inner(%i: i32 loc("i")):
  %again = arith.cmpi slt, %i, %j : i32
  cf.cond_br %again, ^body, ^step
^body:
  %i1 = arith.addi %i, %one : i32
  cf.br ^inner(%i1 : i32)
^step:
  %j1 = arith.addi %j, %one : i32
  cf.br ^outer(%j1 : i32)
^done:
  return %j : i32
}

// -----

// A loop with two exits. The one in its head is what `break` means; the other one goes past what follows.
// CHECK-LABEL: @two_exits(
// CHECK: %[[LEFT:.*]] = rtsl.var "left" : !rtsl.ptr<i1>
// CHECK: rtsl.loop cond {
// CHECK: } do {
// CHECK:   rtsl.if %{{.*}} {
// CHECK:     rtsl.store %{{.*}}, %[[LEFT]]
// CHECK-NEXT: rtsl.break
// CHECK-NEXT: }
// CHECK: }
// CHECK: %[[ASKED:.*]] = rtsl.load %[[LEFT]]
// CHECK: rtsl.if
// CHECK: call @nothingFound
// CHECK: call @after
// CHECK: rtsl.return
func.func private @nothingFound()
func.func private @isIt(i32) -> i1
func.func private @after()
func.func @two_exits(%n: i32) {
  %zero = arith.constant 0 : i32
  %one = arith.constant 1 : i32
  cf.br ^loop(%zero : i32)
^loop(%i: i32 loc("i")):
  %more = arith.cmpi slt, %i, %n : i32
  cf.cond_br %more, ^body, ^not
^body:
  %it = call @isIt(%i) : (i32) -> i1
  cf.cond_br %it, ^rest, ^step
^step:
  %next = arith.addi %i, %one : i32
  cf.br ^loop(%next : i32)
^not:
  call @nothingFound() : () -> ()
  cf.br ^rest
^rest:
  call @after() : () -> ()
  return
}

// -----

// A switch, one arm of which leaves the function.
// CHECK-LABEL: @switch(
// CHECK: rtsl.switch %{{.*}} : i32 {
// CHECK: arm [1, 2] {
// CHECK:   rtsl.store
// CHECK-NEXT: rtsl.break
// CHECK: arm [3] {
// CHECK-NEXT: rtsl.return %{{.*}} : i32
// CHECK: arm default {
// CHECK:   rtsl.store
// CHECK-NEXT: rtsl.break
// CHECK: rtsl.return
func.func @switch(%v: i32) -> i32 {
  %ten = arith.constant 10 : i32
  cf.switch %v : i32, [
    default: ^other,
    1: ^small,
    2: ^small,
    3: ^leave
  ]
^small:
  cf.br ^join(%ten : i32)
^leave:
  return %v : i32
^other:
  %sum = arith.addi %v, %ten : i32
  cf.br ^join(%sum : i32)
^join(%r: i32 loc("result")):
  return %r : i32
}

// -----

// A loop that nothing leaves; what stands after it is there for the verifier.
// CHECK-LABEL: @forever(
// CHECK: rtsl.loop do {
// CHECK-NEXT: call @again
// CHECK-NEXT: rtsl.yield
// CHECK-NEXT: }
// CHECK-NEXT: rtsl.return
func.func private @again()
func.func @forever() {
  cf.br ^loop
^loop:
  call @again() : () -> ()
  cf.br ^loop
}

// -----

// Early returns: no `else`, no flags.
// CHECK-LABEL: @early(
// CHECK: rtsl.if %{{.*}} {
// CHECK-NEXT: rtsl.return %arg1 : f32
// CHECK-NEXT: }
// CHECK: arith.negf
// CHECK: rtsl.if %{{.*}} {
// CHECK-NEXT: rtsl.return
// CHECK-NEXT: }
// CHECK-NEXT: rtsl.return
func.func @early(%c: i1, %x: f32, %d: i1) -> f32 {
  cf.cond_br %c, ^yes, ^no
^yes:
  return %x : f32
^no:
  %n = arith.negf %x : f32
  cf.cond_br %d, ^second, ^third
^second:
  return %n : f32
^third:
  return %x : f32
}

// -----

// Two values that change places need a third.
// CHECK-LABEL: @swap(
// CHECK: %[[A:.*]] = rtsl.var "a"
// CHECK: %[[B:.*]] = rtsl.var "b"
// CHECK: rtsl.loop
// CHECK: %[[OLD:.*]] = rtsl.load %[[A]]
// CHECK-NEXT: %[[OTHER:.*]] = rtsl.load %[[B]]
// CHECK-NEXT: rtsl.store %[[OTHER]], %[[A]]
// CHECK-NEXT: rtsl.store %[[OLD]], %[[B]]
func.func private @goesOn() -> i1
func.func @swap(%x: f32, %y: f32) -> f32 {
  cf.br ^loop(%x, %y : f32, f32)
^loop(%a: f32 loc("a"), %b: f32 loc("b")):
  %c = call @goesOn() : () -> i1
  cf.cond_br %c, ^again, ^done
^again:
  cf.br ^loop(%b, %a : f32, f32)
^done:
  return %a : f32
}

// -----

// A loop that is entered at two blocks, as a state does that resumes in the middle of one: what lies before the header is
// there twice.
// CHECK-LABEL: @irreducible(
// CHECK: call @q
// CHECK: rtsl.loop
// CHECK: call @q
// CHECK-NOT: call @q
// CHECK: rtsl.return
func.func private @goesOn() -> i1
func.func private @step()
func.func private @q()
func.func @irreducible(%v: i1) {
  cf.cond_br %v, ^step, ^q
^q:
  call @q() : () -> ()
  cf.br ^step
^step:
  call @step() : () -> ()
  %again = call @goesOn() : () -> i1
  cf.cond_br %again, ^body, ^exit
^body:
  %u = call @goesOn() : () -> i1
  cf.cond_br %u, ^exit, ^q
^exit:
  return
}

// -----

// A break out of two loops at once: a flag that is tested after the inner one.
// CHECK-LABEL: @far(
// CHECK: rtsl.loop do {
// CHECK:   rtsl.loop cond {
// CHECK:   } do {
// CHECK:     rtsl.if
// CHECK:       rtsl.break
// CHECK:   }
// CHECK:   rtsl.if
// CHECK-NEXT: rtsl.break
// CHECK: rtsl.return
func.func private @more() -> i1
func.func private @enough() -> i1
func.func @far() {
  cf.br ^outer
^outer:
  cf.br ^inner
^inner:
  %c = call @more() : () -> i1
  cf.cond_br %c, ^body, ^outer
^body:
  %e = call @enough() : () -> i1
  cf.cond_br %e, ^done, ^inner
^done:
  return
}

// -----

// An index of a component is computed again where it is used: no variable holds it.
// CHECK-LABEL: @index(
// CHECK: rtsl.loop cond {
// CHECK:   arith.index_castui %{{.*}} : i32 to index
// CHECK:   rtsl.condition
// CHECK: arith.index_castui %{{.*}} : i32 to index
// CHECK: rtsl.return
func.func private @goesOn(f32) -> i1
func.func @index(%v: vector<3xf32>, %i: i32) -> f32 {
  cf.br ^body
^body:
  %at = arith.index_castui %i : i32 to index
  %x = vector.extract %v[%at] : f32 from vector<3xf32>
  %again = call @goesOn(%x) : (f32) -> i1
  cf.cond_br %again, ^body, ^after
^after:
  %y = vector.extract %v[%at] : f32 from vector<3xf32>
  return %y : f32
}
