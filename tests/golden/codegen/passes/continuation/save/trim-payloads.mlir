// RUN: rtsl-opt %s --rtsl-trim-payloads --split-input-file | FileCheck %s

// `unread` is written but never read; `own` is of no use to the ray's programs, so it is a value here;
// `handed` is only copied into the payload of the next ray; `light` is passed.
// CHECK-LABEL: func.func @sends
// CHECK-SAME:    %[[SELF:.*]]: !rtsl.ref<"M">, %[[O:[^:]*]]: vector<3xf32>, %[[X:[^:]*]]: f32
// CHECK:         %[[P:.*]] = rtsl.var "payload" : !rtsl.ptr<!rtsl.struct<"P", {light: f32}>>
// CHECK-NOT:     rtsl.store
// CHECK:         rtsl.trace_payload {{.*}} carries %[[P]]
// CHECK:         %[[L:.*]] = rtsl.load
// CHECK-NEXT:    arith.addf %[[L]], %[[X]]
func.func @sends(%self: !rtsl.ref<"M">, %o: vector<3xf32>, %x: f32) -> f32 {
  %p = rtsl.var "payload" : !rtsl.ptr<!rtsl.struct<"P", {unread: f32, own: f32, handed: f32, light: f32}>>
  %u = rtsl.field %p["unread"] : !rtsl.ptr<!rtsl.struct<"P", {unread: f32, own: f32, handed: f32, light: f32}>> -> !rtsl.ptr<f32>
  %w = rtsl.field %p["own"] : !rtsl.ptr<!rtsl.struct<"P", {unread: f32, own: f32, handed: f32, light: f32}>> -> !rtsl.ptr<f32>
  %h = rtsl.field %p["handed"] : !rtsl.ptr<!rtsl.struct<"P", {unread: f32, own: f32, handed: f32, light: f32}>> -> !rtsl.ptr<f32>
  %l = rtsl.field %p["light"] : !rtsl.ptr<!rtsl.struct<"P", {unread: f32, own: f32, handed: f32, light: f32}>> -> !rtsl.ptr<f32>
  rtsl.store %x, %u : !rtsl.ptr<f32>
  rtsl.store %x, %w : !rtsl.ptr<f32>
  rtsl.store %x, %h : !rtsl.ptr<f32>
  rtsl.trace_payload %o, %o from %x to %x carries %p {ray_type = 1 : i32, how = 0 : i32} : !rtsl.ptr<!rtsl.struct<"P", {unread: f32, own: f32, handed: f32, light: f32}>>
  %a = rtsl.load %l : !rtsl.ptr<f32>
  %b = rtsl.load %w : !rtsl.ptr<f32>
  %s = arith.addf %a, %b : f32
  return %s : f32
}
// CHECK-LABEL: func.func @answers
// CHECK:         %[[Q:.*]] = rtsl.payload : !rtsl.ptr<!rtsl.struct<"P", {light: f32}>>
// CHECK:         rtsl.field %[[Q]]["light"]
// CHECK:         rtsl.store
// CHECK-NOT:     rtsl.store
// CHECK:         rtsl.trace_payload
func.func @answers(%self: !rtsl.ref<"M">, %o: vector<3xf32>, %x: f32) {
  %q = rtsl.payload : !rtsl.ptr<!rtsl.struct<"P", {unread: f32, own: f32, handed: f32, light: f32}>>
  %p = rtsl.var "payload" : !rtsl.ptr<!rtsl.struct<"P", {unread: f32, own: f32, handed: f32, light: f32}>>
  %u = rtsl.field %q["unread"] : !rtsl.ptr<!rtsl.struct<"P", {unread: f32, own: f32, handed: f32, light: f32}>> -> !rtsl.ptr<f32>
  %h = rtsl.field %q["handed"] : !rtsl.ptr<!rtsl.struct<"P", {unread: f32, own: f32, handed: f32, light: f32}>> -> !rtsl.ptr<f32>
  %l = rtsl.field %q["light"] : !rtsl.ptr<!rtsl.struct<"P", {unread: f32, own: f32, handed: f32, light: f32}>> -> !rtsl.ptr<f32>
  %n = rtsl.field %p["handed"] : !rtsl.ptr<!rtsl.struct<"P", {unread: f32, own: f32, handed: f32, light: f32}>> -> !rtsl.ptr<f32>
  rtsl.store %x, %u : !rtsl.ptr<f32>
  rtsl.store %x, %l : !rtsl.ptr<f32>
  %a = rtsl.load %h : !rtsl.ptr<f32>
  rtsl.store %a, %n : !rtsl.ptr<f32>
  rtsl.trace_payload %o, %o from %x to %x carries %p {ray_type = 1 : i32, how = 0 : i32} : !rtsl.ptr<!rtsl.struct<"P", {unread: f32, own: f32, handed: f32, light: f32}>>
  return
}

// -----

// Not linked: other classes may read it.
// CHECK-LABEL: func.func @alone
// CHECK:         rtsl.var "payload" : !rtsl.ptr<!rtsl.struct<"P", {unread: f32, light: f32}>>
func.func @alone(%self: !rtsl.ref<"M">, %o: vector<3xf32>, %x: f32) -> f32 {
  %p = rtsl.var "payload" : !rtsl.ptr<!rtsl.struct<"P", {unread: f32, light: f32}>>
  %u = rtsl.field %p["unread"] : !rtsl.ptr<!rtsl.struct<"P", {unread: f32, light: f32}>> -> !rtsl.ptr<f32>
  %l = rtsl.field %p["light"] : !rtsl.ptr<!rtsl.struct<"P", {unread: f32, light: f32}>> -> !rtsl.ptr<f32>
  rtsl.store %x, %u : !rtsl.ptr<f32>
  rtsl.trace_payload %o, %o from %x to %x carries %p : !rtsl.ptr<!rtsl.struct<"P", {unread: f32, light: f32}>>
  %a = rtsl.load %l : !rtsl.ptr<f32>
  return %a : f32
}

// MUTATION trim-payloads of save/TrimPayloads.cpp: nothing counts as read
// - uses[field].isRead |= !isHandedOn;
// + uses[field].isRead |= false;
