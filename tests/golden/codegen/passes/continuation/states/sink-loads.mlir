// RUN: rtsl-opt %s --rtsl-sink-loads | FileCheck %s

// Needed on one of two ways only.
// CHECK-LABEL: func.func @branch
// CHECK-NEXT:   cf.cond_br %arg0, ^bb1, ^bb2
// CHECK-NEXT: ^bb1:
// CHECK-NEXT:   rtsl.frame_load "w"[0] : f32
// CHECK-NEXT:   arith.addf
func.func @branch(%p: i1) -> i32 {
  %w = rtsl.frame_load "w"[0] : f32
  cf.cond_br %p, ^yes, ^no
^yes:
  %d = arith.addf %w, %w : f32
  %a = rtsl.to_sint %d : f32
  rtsl.end %a
^no:
  %n = rtsl.next done
  rtsl.end %n
}

// Never into a loop: it would be loaded each time round.
// CHECK-LABEL: func.func @loop
// CHECK-NEXT:   cf.cond_br %arg0, ^bb1, ^bb3
// CHECK-NEXT: ^bb1:
// CHECK-NEXT:   %[[W:.*]] = rtsl.frame_load "w"[0] : f32
// CHECK-NEXT:   cf.br ^bb2(%arg1 : f32)
// CHECK-NEXT: ^bb2(%[[S:.*]]: f32):
// CHECK-NEXT:   arith.addf %[[S]], %[[W]]
func.func @loop(%p: i1, %x: f32) -> i32 {
  %w = rtsl.frame_load "w"[0] : f32
  cf.cond_br %p, ^before, ^end
^before:
  cf.br ^loop(%x : f32)
^loop(%s: f32):
  %t = arith.addf %s, %w : f32
  %q = arith.cmpf olt, %t, %x : f32
  cf.cond_br %q, ^loop(%t : f32), ^end
^end:
  %n = rtsl.next done
  rtsl.end %n
}

// State may be written on the way, so a load of it stays; a member is constant and goes.
// CHECK-LABEL: func.func @state
// CHECK:        %[[PDF:.*]] = rtsl.load
// CHECK-NEXT:   cf.cond_br
func.func @state(%p: i1) -> i32 {
  %a = rtsl.state "PDF" : !rtsl.ptr<f32>
  %v = rtsl.load %a : !rtsl.ptr<f32>
  cf.cond_br %p, ^yes, ^no
^yes:
  %i = rtsl.to_sint %v : f32
  rtsl.end %i
^no:
  %n = rtsl.next done
  rtsl.end %n
}

// An object lies over the slot at other times and may be written before the use: the load stays where the state begins.
// CHECK-LABEL: func.func @shared
// CHECK-NEXT:   rtsl.frame_load "w"[0] {rtsl.shared} : f32
// CHECK-NEXT:   cf.cond_br
func.func @shared(%p: i1) -> i32 {
  %w = rtsl.frame_load "w"[0] {rtsl.shared} : f32
  cf.cond_br %p, ^yes, ^no
^yes:
  %d = arith.addf %w, %w : f32
  %a = rtsl.to_sint %d : f32
  rtsl.end %a
^no:
  %n = rtsl.next done
  rtsl.end %n
}

// MUTATION sink-loads of states/SinkLoads.cpp: loads move into loops
// -     while (target != &entry && loops.getLoopDepth(target) != 0)
// -       target = dominance.getNode(target)->getIDom()->getBlock();

// MUTATION shared-loads of states/SinkLoads.cpp: what lies over an object is loaded late all the same
// -     return !ir::attr::shared.isOn(&op);
// +     return true;
