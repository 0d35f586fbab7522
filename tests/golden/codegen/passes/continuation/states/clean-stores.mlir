// RUN: rtsl-opt %s --rtsl-clean-stores | FileCheck %s

// Loaded and stored unchanged: neither is needed.
// CHECK-LABEL: func.func @unchanged
// CHECK-NEXT:   rtsl.trace_result
// CHECK-NEXT:   rtsl.spawn
func.func @unchanged() -> i32 {
  %c = rtsl.trace_result : vector<3xf32>
  %w = rtsl.frame_load "w"[0] : f32
  rtsl.frame_store %w, "w"[0] : f32
  rtsl.spawn %c, %c
  %n = rtsl.next trace @s
  rtsl.end %n
}

// Changed on one of two ways.
// CHECK-LABEL: func.func @changed
// CHECK:        rtsl.frame_store
func.func @changed(%p: i1) -> i32 {
  %c = rtsl.trace_result : vector<3xf32>
  %w = rtsl.frame_load "w"[0] : f32
  cf.cond_br %p, ^double, ^end(%w : f32)
^double:
  %d = arith.addf %w, %w : f32
  cf.br ^end(%d : f32)
^end(%v: f32):
  rtsl.frame_store %v, "w"[0] : f32
  rtsl.spawn %c, %c
  %n = rtsl.next trace @s
  rtsl.end %n
}

// The same value on both ways, and round a loop.
// CHECK-LABEL: func.func @same
// CHECK-NOT:    rtsl.frame_store
// CHECK:        rtsl.spawn
func.func @same(%p: i1) -> i32 {
  %c = rtsl.trace_result : vector<3xf32>
  %w = rtsl.frame_load "w"[0] : f32
  cf.br ^loop(%w : f32)
^loop(%u: f32):
  cf.cond_br %p, ^loop(%u : f32), ^end(%u : f32)
^end(%v: f32):
  rtsl.frame_store %v, "w"[0] : f32
  rtsl.spawn %c, %c
  %n = rtsl.next trace @s
  rtsl.end %n
}

// From another slot, or a slot that was overwritten: the store stays.
// CHECK-LABEL: func.func @moved
// CHECK:        rtsl.frame_store %[[W:.*]], "v"[4]
// CHECK:        rtsl.frame_store %{{.*}}, "x"[0]
// CHECK:        rtsl.frame_store %[[W]], "w"[0]
func.func @moved(%x: f32) -> i32 {
  %c = rtsl.trace_result : vector<3xf32>
  %w = rtsl.frame_load "w"[0] : f32
  rtsl.frame_store %w, "v"[4] : f32
  rtsl.frame_store %x, "x"[0] : f32
  rtsl.frame_store %w, "w"[0] : f32
  rtsl.spawn %c, %c
  %n = rtsl.next trace @s
  rtsl.end %n
}

// An object lies over the slot at other times, so it may have been written since: the store stays.
// CHECK-LABEL: func.func @shared
// CHECK:        rtsl.frame_store
func.func @shared() -> i32 {
  %c = rtsl.trace_result : vector<3xf32>
  %w = rtsl.frame_load "w"[0] {rtsl.shared} : f32
  rtsl.frame_store %w, "w"[0] {rtsl.shared} : f32
  rtsl.spawn %c, %c
  %n = rtsl.next trace @s
  rtsl.end %n
}

// From another slot at the same place: where frames are printed these are two fields.
// CHECK-LABEL: func.func @renamed
// CHECK:        rtsl.frame_store %{{.*}}, "w.2"[0]
func.func @renamed() -> i32 {
  %c = rtsl.trace_result : vector<3xf32>
  %w = rtsl.frame_load "w"[0] : f32
  rtsl.frame_store %w, "w.2"[0] : f32
  rtsl.spawn %c, %c
  %n = rtsl.next trace @s
  rtsl.end %n
}

// MUTATION clean-stores of states/CleanStores.cpp: a slot holds what was loaded from another one
// -         return isSame(load);
// +         return true;

// MUTATION shared-stores of states/CleanStores.cpp: what lies over an object is kept by its slot all the same
// - !ir::attr::shared.isOn(store) &&
// + true &&
