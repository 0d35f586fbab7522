// RUN: rtsl-opt %s --rtsl-share-calls | FileCheck %s
// Calls of a function that only reads what its caller does not write.

func.func private @frame(%axes: !rtsl.ptr<!rtsl.array<3 x f32>>) {
  %zero = arith.constant 0 : i32
  %state = rtsl.state "HitDistance" : !rtsl.ptr<f32>
  %distance = rtsl.load %state : !rtsl.ptr<f32>
  %first = rtsl.element %axes[%zero] : !rtsl.ptr<!rtsl.array<3 x f32>> -> !rtsl.ptr<f32>
  rtsl.store %distance, %first : !rtsl.ptr<f32>
  return
}
func.func private @pure(%x: f32) -> f32 {
  %state = rtsl.state "Epsilon" : !rtsl.ptr<f32>
  %epsilon = rtsl.load %state : !rtsl.ptr<f32>
  %sum = arith.addf %x, %epsilon : f32
  return %sum : f32
}
func.func private @draws() -> f32 {
  %number = rtsl.rand
  return %number : f32
}

// One call, before the branch, since both sides come to one.
// CHECK-LABEL: func.func @branch
// CHECK:         %[[AXES:.*]] = rtsl.var "a"
// CHECK:         call @frame(%[[AXES]])
// CHECK-NEXT:    cf.cond_br
// CHECK-NOT:     call
// CHECK:         rtsl.element %[[AXES]]
// CHECK-NOT:     call
// CHECK:         rtsl.element %[[AXES]]
// CHECK-NOT:     call
// CHECK:         return
func.func @branch(%isLit: i1) -> f32 {
  %zero = arith.constant 0 : i32
  %a = rtsl.var "a" : !rtsl.ptr<!rtsl.array<3 x f32>>
  %b = rtsl.var "b" : !rtsl.ptr<!rtsl.array<3 x f32>>
  cf.cond_br %isLit, ^lit, ^next(%zero : i32)
^lit:
  rtsl.clear %a : !rtsl.ptr<!rtsl.array<3 x f32>>
  call @frame(%a) : (!rtsl.ptr<!rtsl.array<3 x f32>>) -> ()
  %ofA = rtsl.element %a[%zero] : !rtsl.ptr<!rtsl.array<3 x f32>> -> !rtsl.ptr<f32>
  %x = rtsl.load %ofA : !rtsl.ptr<f32>
  %i = arith.fptosi %x : f32 to i32
  cf.br ^next(%i : i32)
^next(%j: i32):
  call @frame(%b) : (!rtsl.ptr<!rtsl.array<3 x f32>>) -> ()
  %ofB = rtsl.element %b[%j] : !rtsl.ptr<!rtsl.array<3 x f32>> -> !rtsl.ptr<f32>
  %y = rtsl.load %ofB : !rtsl.ptr<f32>
  return %y : f32
}

// Only one side comes to a call: none is added to the other.
// CHECK-LABEL: func.func @oneSide
// CHECK:         cf.cond_br
// CHECK:         call @pure
// CHECK:         call @pure
func.func @oneSide(%a: i1, %b: i1, %x: f32) -> f32 {
  cf.cond_br %a, ^one, ^other(%x : f32)
^one:
  %first = call @pure(%x) : (f32) -> f32
  cf.br ^other(%first : f32)
^other(%y: f32):
  cf.cond_br %b, ^two, ^end(%y : f32)
^two:
  %second = call @pure(%x) : (f32) -> f32
  cf.br ^end(%second : f32)
^end(%z: f32):
  return %z : f32
}

// The second call replaces no call before a ray: its result would be saved.
// CHECK-LABEL: func.func @ray
// CHECK:         call @pure
// CHECK:         rtsl.illuminate
// CHECK:         call @pure
// CHECK-NOT:     call @pure
func.func @ray(%x: f32, %p: vector<3xf32>) -> f32 {
  %before = call @pure(%x) : (f32) -> f32
  %isLit = rtsl.illuminate %p
  %after = call @pure(%x) : (f32) -> f32
  %again = call @pure(%x) : (f32) -> f32
  %part = arith.addf %before, %after : f32
  %sum = arith.addf %part, %again : f32
  return %sum : f32
}

// The caller writes what the function reads.
// CHECK-LABEL: func.func @written
// CHECK:         call @pure
// CHECK:         call @pure
func.func @written(%x: f32) -> f32 {
  %state = rtsl.state "Epsilon" : !rtsl.ptr<f32>
  %before = call @pure(%x) : (f32) -> f32
  rtsl.store %before, %state : !rtsl.ptr<f32>
  %after = call @pure(%x) : (f32) -> f32
  return %after : f32
}

// An argument may be the state that the function reads.
// CHECK-LABEL: func.func @argument
// CHECK:         call @pure
// CHECK:         call @pure
func.func @argument(%x: f32, %state: !rtsl.ptr<f32>) -> f32 {
  %before = call @pure(%x) : (f32) -> f32
  rtsl.store %before, %state : !rtsl.ptr<f32>
  %after = call @pure(%x) : (f32) -> f32
  return %after : f32
}

// A hit may write what the function reads.
// CHECK-LABEL: func.func @hits
// CHECK:         call @pure
// CHECK:         call @pure
func.func @hits(%x: f32) -> f32 {
  %before = call @pure(%x) : (f32) -> f32
  %is_hit = rtsl.hit %before
  %after = call @pure(%x) : (f32) -> f32
  return %after : f32
}

// A variable that still holds what an earlier iteration wrote is no result; one that is cleared is.
// CHECK-LABEL: func.func @loop
// CHECK-COUNT-3: call @frame
// CHECK-NOT:     call
// CHECK:         return
func.func @loop(%again: i1) -> f32 {
  %zero = arith.constant 0 : i32
  %kept = rtsl.var "kept" : !rtsl.ptr<!rtsl.array<3 x f32>>
  %other = rtsl.var "other" : !rtsl.ptr<!rtsl.array<3 x f32>>
  %a = rtsl.var "a" : !rtsl.ptr<!rtsl.array<3 x f32>>
  %b = rtsl.var "b" : !rtsl.ptr<!rtsl.array<3 x f32>>
  cf.br ^next
^next:
  rtsl.clear %a : !rtsl.ptr<!rtsl.array<3 x f32>>
  rtsl.clear %b : !rtsl.ptr<!rtsl.array<3 x f32>>
  call @frame(%kept) : (!rtsl.ptr<!rtsl.array<3 x f32>>) -> ()
  call @frame(%other) : (!rtsl.ptr<!rtsl.array<3 x f32>>) -> ()
  call @frame(%a) : (!rtsl.ptr<!rtsl.array<3 x f32>>) -> ()
  call @frame(%b) : (!rtsl.ptr<!rtsl.array<3 x f32>>) -> ()
  %of_kept = rtsl.element %kept[%zero] : !rtsl.ptr<!rtsl.array<3 x f32>> -> !rtsl.ptr<f32>
  %of_other = rtsl.element %other[%zero] : !rtsl.ptr<!rtsl.array<3 x f32>> -> !rtsl.ptr<f32>
  %of_a = rtsl.element %a[%zero] : !rtsl.ptr<!rtsl.array<3 x f32>> -> !rtsl.ptr<f32>
  %of_b = rtsl.element %b[%zero] : !rtsl.ptr<!rtsl.array<3 x f32>> -> !rtsl.ptr<f32>
  %first = rtsl.load %of_kept : !rtsl.ptr<f32>
  %second = rtsl.load %of_other : !rtsl.ptr<f32>
  %third = rtsl.load %of_a : !rtsl.ptr<f32>
  %fourth = rtsl.load %of_b : !rtsl.ptr<f32>
  %sum = arith.addf %first, %second : f32
  %other_sum = arith.addf %third, %fourth : f32
  %all = arith.addf %sum, %other_sum : f32
  cf.cond_br %again, ^next, ^end(%all : f32)
^end(%result: f32):
  return %result : f32
}

// A variable that something else writes, or that is read before the call, is no result.
// CHECK-LABEL: func.func @variables
// CHECK-COUNT-3: call @frame
func.func @variables() -> f32 {
  %zero = arith.constant 0 : i32
  %half = arith.constant 0.5 : f32
  %a = rtsl.var "a" : !rtsl.ptr<!rtsl.array<3 x f32>>
  %b = rtsl.var "b" : !rtsl.ptr<!rtsl.array<3 x f32>>
  %c = rtsl.var "c" : !rtsl.ptr<!rtsl.array<3 x f32>>
  call @frame(%a) : (!rtsl.ptr<!rtsl.array<3 x f32>>) -> ()
  call @frame(%b) : (!rtsl.ptr<!rtsl.array<3 x f32>>) -> ()
  %ofA = rtsl.element %a[%zero] : !rtsl.ptr<!rtsl.array<3 x f32>> -> !rtsl.ptr<f32>
  %ofB = rtsl.element %b[%zero] : !rtsl.ptr<!rtsl.array<3 x f32>> -> !rtsl.ptr<f32>
  %ofC = rtsl.element %c[%zero] : !rtsl.ptr<!rtsl.array<3 x f32>> -> !rtsl.ptr<f32>
  rtsl.store %half, %ofB : !rtsl.ptr<f32>
  %early = rtsl.load %ofC : !rtsl.ptr<f32>
  call @frame(%c) : (!rtsl.ptr<!rtsl.array<3 x f32>>) -> ()
  %x = rtsl.load %ofA : !rtsl.ptr<f32>
  %y = rtsl.load %ofB : !rtsl.ptr<f32>
  %z = rtsl.load %ofC : !rtsl.ptr<f32>
  %xy = arith.addf %x, %y : f32
  %xyz = arith.addf %xy, %z : f32
  %sum = arith.addf %xyz, %early : f32
  return %sum : f32
}

// What nothing reads is not computed, unless more than that is done.
// CHECK-LABEL: func.func @unread
// CHECK-NOT:     call @pure
// CHECK-NOT:     call @frame
// CHECK-COUNT-2: call @draws
func.func @unread(%x: f32) {
  %a = rtsl.var "a" : !rtsl.ptr<!rtsl.array<3 x f32>>
  %y = call @pure(%x) : (f32) -> f32
  call @frame(%a) : (!rtsl.ptr<!rtsl.array<3 x f32>>) -> ()
  %r = call @draws() : () -> f32
  %s = call @draws() : () -> f32
  return
}
