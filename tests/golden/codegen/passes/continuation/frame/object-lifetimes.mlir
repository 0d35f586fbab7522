// RUN: rtsl-opt %s --rtsl-insert-suspends --rtsl-frame-objects --rtsl-rematerialise --rtsl-save-live --rtsl-layout-frame | FileCheck %s

// The first payload is not wanted any more when the second is filled, so they lie in the same words.
// CHECK-LABEL: func.func @oneAfterTheOther
// CHECK-SAME:    rtsl.frame_size = 4 : i32
// CHECK-DAG:     rtsl.frame_object "first"[0]
// CHECK-DAG:     rtsl.frame_object "second"[0]
func.func @oneAfterTheOther(%t: f32) {
  %h = rtsl.state "HitPoint" : !rtsl.ptr<vector<3xf32>>
  %o = rtsl.load %h : !rtsl.ptr<vector<3xf32>>
  %a = rtsl.var "first" : !rtsl.ptr<!rtsl.struct<"P", {x: f32}>>
  rtsl.trace_payload %o, %o from %t to %t carries %a : !rtsl.ptr<!rtsl.struct<"P", {x: f32}>>
  %ax = rtsl.field %a["x"] : !rtsl.ptr<!rtsl.struct<"P", {x: f32}>> -> !rtsl.ptr<f32>
  %x = rtsl.load %ax : !rtsl.ptr<f32>
  %b = rtsl.var "second" : !rtsl.ptr<!rtsl.struct<"P", {x: f32}>>
  %bx = rtsl.field %b["x"] : !rtsl.ptr<!rtsl.struct<"P", {x: f32}>> -> !rtsl.ptr<f32>
  rtsl.store %x, %bx : !rtsl.ptr<f32>
  rtsl.trace_payload %o, %o from %x to %x carries %b : !rtsl.ptr<!rtsl.struct<"P", {x: f32}>>
  return
}

// Here the first is read when the second has been cleared: each has its own words.
// CHECK-LABEL: func.func @atTheSameTime
// CHECK-SAME:    rtsl.frame_size = 8 : i32
// CHECK-DAG:     rtsl.frame_object "first"[0]
// CHECK-DAG:     rtsl.frame_object "second"[4]
func.func @atTheSameTime(%t: f32) {
  %h = rtsl.state "HitPoint" : !rtsl.ptr<vector<3xf32>>
  %o = rtsl.load %h : !rtsl.ptr<vector<3xf32>>
  %a = rtsl.var "first" : !rtsl.ptr<!rtsl.struct<"P", {x: f32}>>
  rtsl.trace_payload %o, %o from %t to %t carries %a : !rtsl.ptr<!rtsl.struct<"P", {x: f32}>>
  %b = rtsl.var "second" : !rtsl.ptr<!rtsl.struct<"P", {x: f32}>>
  %ax = rtsl.field %a["x"] : !rtsl.ptr<!rtsl.struct<"P", {x: f32}>> -> !rtsl.ptr<f32>
  %x = rtsl.load %ax : !rtsl.ptr<f32>
  rtsl.trace_payload %o, %o from %x to %x carries %b : !rtsl.ptr<!rtsl.struct<"P", {x: f32}>>
  return
}

// A value shares words with a payload that is sent when it is not wanted. Its loads stay at the beginning then, and its
// stores are made, for between them the payload may have lain there.
// CHECK-LABEL: func.func @valueAndObject
// CHECK-SAME:    rtsl.frame_size = 4 : i32
// CHECK:         rtsl.frame_store %{{.*}}, "w"[0] {rtsl.shared} : f32
// CHECK:         rtsl.frame_load "w"[0] {rtsl.shared} : f32
// CHECK:         rtsl.frame_object "payload"[0]
func.func @valueAndObject(%d: vector<3xf32>) {
  %w = rtsl.rand loc("w")
  %a = rtsl.state "HitPoint" : !rtsl.ptr<vector<3xf32>>
  %o = rtsl.load %a : !rtsl.ptr<vector<3xf32>>
  %c = rtsl.trace %o, %o : vector<3xf32>
  %p = rtsl.var "payload" : !rtsl.ptr<!rtsl.struct<"P", {x: f32}>>
  %px = rtsl.field %p["x"] : !rtsl.ptr<!rtsl.struct<"P", {x: f32}>> -> !rtsl.ptr<f32>
  rtsl.store %w, %px : !rtsl.ptr<f32>
  rtsl.trace_payload %c, %c from %w to %w carries %p : !rtsl.ptr<!rtsl.struct<"P", {x: f32}>>
  return
}

// MUTATION object-lifetimes of frame/ObjectLifetimes.cpp: an object overlaps no object that is live with it
// -       lifetimes[number].objects |= live;
