// Every type and op prints as it was written, and what was printed reads back the same.
// RUN: rtsl-opt %s | FileCheck %s
// RUN: rtsl-opt %s | rtsl-opt | FileCheck %s

// CHECK-LABEL: rtsl.class @Base root "rt_Material" {
// CHECK-NEXT: rtsl.member_decl @eta : f32 access "public"
// CHECK-NEXT: rtsl.member_decl @n : vector<3xf32> access "scratch"
// CHECK: rtsl.class @Glass root "rt_Material" base @Base {
rtsl.class @Base root "rt_Material" {
  rtsl.member_decl @eta : f32 access "public"
  rtsl.member_decl @n : vector<3xf32> access "scratch"
}
rtsl.class @Glass root "rt_Material" base @Base {
  rtsl.member_decl @eta : f32 access "public"
  rtsl.member_decl @albedo : !rtsl.ref<"rt_Texture"> access "private"
  rtsl.member_decl @vertices : !rtsl.buffer<vector<3xf32>, 2> access "public"
}
// CHECK: rtsl.class @Nothing root "rt_Texture" {
// CHECK-NEXT: }
rtsl.class @Nothing root "rt_Texture" {
}

// CHECK-LABEL: func.func @memory(
func.func @memory(%self: !rtsl.ref<"Glass">, %i: i32, %j: i32) attributes {rtsl.class = "Glass", rtsl.constructor, rtsl.method = "constructor"} {
  // CHECK: %ray = rtsl.var "ray" : !rtsl.ptr<!rtsl.struct<"Ray", {origin: vector<3xf32>, mask: i32, end: i1}>>
  %ray = rtsl.var "ray" : !rtsl.ptr<!rtsl.struct<"Ray", {origin: vector<3xf32>, mask: i32, "end": i1}>>
  // CHECK: %m = rtsl.var "m" : !rtsl.ptr<!rtsl.array<3 x vector<3xf32>>>
  %m = rtsl.var "m" : !rtsl.ptr<!rtsl.array<3 x vector<3xf32>>>
  // CHECK: %wide = rtsl.var "wide" : !rtsl.ptr<f64>
  %wide = rtsl.var "wide" : !rtsl.ptr<f64>
  // CHECK: rtsl.clear %m : !rtsl.ptr<!rtsl.array<3 x vector<3xf32>>>
  rtsl.clear %m : !rtsl.ptr<!rtsl.array<3 x vector<3xf32>>>
  // CHECK: rtsl.field %ray["origin"] : !rtsl.ptr<!rtsl.struct<"Ray", {origin: vector<3xf32>, mask: i32, end: i1}>> -> !rtsl.ptr<vector<3xf32>>
  %o = rtsl.field %ray["origin"] : !rtsl.ptr<!rtsl.struct<"Ray", {origin: vector<3xf32>, mask: i32, "end": i1}>> -> !rtsl.ptr<vector<3xf32>>
  // CHECK: rtsl.element %m[%{{.*}}] : !rtsl.ptr<!rtsl.array<3 x vector<3xf32>>> -> !rtsl.ptr<vector<3xf32>>
  %c = rtsl.element %m[%i] : !rtsl.ptr<!rtsl.array<3 x vector<3xf32>>> -> !rtsl.ptr<vector<3xf32>>
  // CHECK: rtsl.load %{{.*}} : !rtsl.ptr<vector<3xf32>>
  %v = rtsl.load %o : !rtsl.ptr<vector<3xf32>>
  // CHECK: rtsl.store %{{.*}}, %{{.*}} : !rtsl.ptr<vector<3xf32>>
  rtsl.store %v, %c : !rtsl.ptr<vector<3xf32>>
  // CHECK: rtsl.copy %{{.*}} to %{{.*}} : !rtsl.ptr<vector<3xf32>>
  rtsl.copy %o to %c : !rtsl.ptr<vector<3xf32>>
  // CHECK: %eta = rtsl.member %{{.*}}["eta"] : !rtsl.ref<"Glass"> -> !rtsl.ptr<f32>
  %eta = rtsl.member %self["eta"] : !rtsl.ref<"Glass"> -> !rtsl.ptr<f32>
  // CHECK: %RayOrigin = rtsl.state "RayOrigin" : !rtsl.ptr<vector<3xf32>>
  %origin = rtsl.state "RayOrigin" : !rtsl.ptr<vector<3xf32>>
  // CHECK: %SampleColor = rtsl.state "SampleColor" : !rtsl.ptr<vector<1xf32>>
  %color = rtsl.state "SampleColor" : !rtsl.ptr<vector<1xf32>>
  // CHECK: %n = rtsl.attribute "n" : !rtsl.ptr<vector<3xf32>>
  %n = rtsl.attribute "n" : !rtsl.ptr<vector<3xf32>>
  // CHECK: rtsl.attribute "n" {offset = 4 : i32} : !rtsl.ptr<vector<3xf32>>
  %n2 = rtsl.attribute "n" {offset = 4 : i32} : !rtsl.ptr<vector<3xf32>>
  %b = rtsl.member %self["vertices"] : !rtsl.ref<"Glass"> -> !rtsl.ptr<!rtsl.buffer<vector<3xf32>, 2>>
  // CHECK: rtsl.buffer_element %vertices[%{{.*}}, %{{.*}}] : !rtsl.ptr<!rtsl.buffer<vector<3xf32>, 2>> -> !rtsl.ptr<vector<3xf32>>
  %e = rtsl.buffer_element %b[%i, %j] : !rtsl.ptr<!rtsl.buffer<vector<3xf32>, 2>> -> !rtsl.ptr<vector<3xf32>>
  // CHECK: rtsl.buffer_length %vertices, 1 : !rtsl.ptr<!rtsl.buffer<vector<3xf32>, 2>>
  %l = rtsl.buffer_length %b, 1 : !rtsl.ptr<!rtsl.buffer<vector<3xf32>, 2>>
  // CHECK: rtsl.return{{$}}
  rtsl.return
}

// CHECK-LABEL: func.func @references(
func.func @references(%self: !rtsl.ref<"Glass">, %x: f32) -> f32 {
  // CHECK: rtsl.null_ref : !rtsl.ref<"rt_Texture">
  %none = rtsl.null_ref : !rtsl.ref<"rt_Texture">
  // CHECK: rtsl.cast_ref %{{.*}} : !rtsl.ref<"Glass"> -> !rtsl.ref<"rt_Material">
  %up = rtsl.cast_ref %self : !rtsl.ref<"Glass"> -> !rtsl.ref<"rt_Material">
  // CHECK: rtsl.class_id %{{.*}} : !rtsl.ref<"rt_Material">
  %id = rtsl.class_id %up : !rtsl.ref<"rt_Material">
  // CHECK: rtsl.equal_ref %{{.*}}, %{{.*}} : !rtsl.ref<"Glass">, !rtsl.ref<"rt_Texture">
  %same = rtsl.equal_ref %self, %none : !rtsl.ref<"Glass">, !rtsl.ref<"rt_Texture">
  // CHECK: rtsl.call_method "lookup" on %{{.*}}() : !rtsl.ref<"rt_Texture">, () -> ()
  rtsl.call_method "lookup" on %none() : !rtsl.ref<"rt_Texture">, () -> ()
  // CHECK: rtsl.call_method "weight" on %{{.*}}(%{{.*}}) : !rtsl.ref<"rt_Material">, (f32) -> f32
  %w = rtsl.call_method "weight" on %up(%x) : !rtsl.ref<"rt_Material">, (f32) -> f32
  // CHECK: rtsl.return %{{.*}} : f32
  rtsl.return %w : f32
}

// CHECK-LABEL: func.func @rays(
func.func @rays(%p: vector<3xf32>, %t: f32, %i: i32) {
  // CHECK: rtsl.trace %{{.*}}, %{{.*}} : vector<4xf32>
  %c = rtsl.trace %p, %p : vector<4xf32>
  // CHECK: %[[PAYLOAD:.*]] = rtsl.payload : !rtsl.ptr<!rtsl.struct<"P", {x: f32}>>
  // CHECK-NEXT: %[[TYPE:.*]] = rtsl.ray_type
  // CHECK: rtsl.trace_payload %{{.*}}, %{{.*}} from %{{.*}} to %{{.*}} carries %[[PAYLOAD]] root %[[TYPE]] mask %[[TYPE]] time %{{.*}} {how = 2 : i32, ray_type = 1 : i32} :
  // CHECK: rtsl.trace_payload %{{.*}}, %{{.*}} from %{{.*}} to %{{.*}} carries %[[PAYLOAD]] : !rtsl.ptr
  // CHECK-NEXT: rtsl.answer_hit ignore
  // CHECK-NEXT: %{{.*}} = rtsl.hit_answered
  %payload = rtsl.payload : !rtsl.ptr<!rtsl.struct<"P", {x: f32}>>
  %type = rtsl.ray_type
  %tmax = arith.constant 2.0 : f32
  rtsl.trace_payload %p, %p from %tmax to %tmax carries %payload root %type mask %type time %tmax {ray_type = 1 : i32, how = 2 : i32} : !rtsl.ptr<!rtsl.struct<"P", {x: f32}>>
  rtsl.trace_payload %p, %p from %tmax to %tmax carries %payload : !rtsl.ptr<!rtsl.struct<"P", {x: f32}>>
  rtsl.answer_hit ignore
  %answered = rtsl.hit_answered
  // CHECK: rtsl.hit %{{.*}}
  %h = rtsl.hit %t
  // CHECK: rtsl.ambient : vector<4xf32>
  %a = rtsl.ambient : vector<4xf32>
  // CHECK: rtsl.rand{{$}}
  %r = rtsl.rand
  // CHECK: rtsl.light_count{{$}}
  %n = rtsl.light_count
  // CHECK: rtsl.illuminate %{{.*}} light %{{.*}}{{$}}
  %lit = rtsl.illuminate %p light %i
  // CHECK: rtsl.illuminate %{{.*}} light %{{.*}} normal %{{.*}} cos %{{.*}}
  %lit2 = rtsl.illuminate %p light %i normal %p cos %t
  // CHECK: rtsl.illuminate %{{[^ ]*}}{{$}}
  %lit3 = rtsl.illuminate %p
  // CHECK: rtsl.illuminate %{{[^ ]*}} normal %{{[^ ]*}}{{$}}
  %lit4 = rtsl.illuminate %p normal %p
  rtsl.return
}

// CHECK-LABEL: func.func @numbers(
func.func @numbers(%x: f32, %v: vector<3xf32>, %i: i32, %w: vector<2xi32>) {
  // CHECK: rtsl.elementary <sin> %{{.*}} : f32
  %s = rtsl.elementary <sin> %x : f32
  // CHECK: rtsl.elementary <pow> %{{.*}}, %{{.*}} : vector<3xf32>
  %p = rtsl.elementary <pow> %v, %v : vector<3xf32>
  // CHECK: rtsl.to_sint %{{.*}} : f32
  %a = rtsl.to_sint %x : f32
  // CHECK: rtsl.to_uint %{{.*}} : vector<3xf32>
  %b = rtsl.to_uint %v : vector<3xf32>
  // CHECK: rtsl.sdiv %{{.*}}, %{{.*}} : i32
  %c = rtsl.sdiv %i, %i : i32
  // CHECK: rtsl.udiv %{{.*}}, %{{.*}} : vector<2xi32>
  %d = rtsl.udiv %w, %w : vector<2xi32>
  // CHECK: rtsl.srem
  %e = rtsl.srem %i, %i : i32
  // CHECK: rtsl.urem
  %f = rtsl.urem %i, %i : i32
  rtsl.return
}

// CHECK-LABEL: func.func @control(
func.func @control(%c: i1, %v: i32, %p: vector<3xf32>, %x: f32) {
  // CHECK: rtsl.if %{{.*}} {
  // CHECK-NEXT: rtsl.return
  // CHECK-NEXT: } else {
  // CHECK-NEXT: rtsl.yield
  // CHECK-NEXT: }
  rtsl.if %c {
    rtsl.return
  } else {
    rtsl.yield
  }
  // CHECK: rtsl.loop cond {
  // CHECK-NEXT: rtsl.condition %{{.*}}
  // CHECK-NEXT: } do {
  // CHECK-NEXT: rtsl.break
  // CHECK-NEXT: } step {
  // CHECK-NEXT: rtsl.yield
  // CHECK-NEXT: }
  rtsl.loop cond {
    rtsl.condition %c
  } do {
    rtsl.break
  } step {
    rtsl.yield
  }
  // CHECK: rtsl.loop post_test cond {
  rtsl.loop post_test cond {
    rtsl.condition %c
  } do {
    rtsl.continue
  }
  // CHECK: rtsl.loop do {
  rtsl.loop do {
    rtsl.break
  }
  // CHECK: rtsl.switch %{{.*}} : i32 {
  // CHECK-NEXT: arm [1, -2] {
  // CHECK-NEXT: rtsl.yield
  // CHECK-NEXT: }
  // CHECK-NEXT: arm [3] default {
  // CHECK-NEXT: rtsl.break
  // CHECK-NEXT: }
  // CHECK-NEXT: }
  rtsl.switch %v : i32 {
    arm [1, -2] {
      rtsl.yield
    }
    arm [3] default {
      rtsl.break
    }
  }
  // CHECK: rtsl.switch %{{.*}} : i32 {
  // CHECK-NEXT: arm default {
  rtsl.switch %v : i32 {
    arm default {
      rtsl.yield
    }
  }
  // CHECK: rtsl.illuminance %{{.*}} {
  rtsl.illuminance %p {
    rtsl.continue
  }
  // CHECK: rtsl.illuminance %{{.*}} normal %{{.*}} cos %{{.*}} {
  rtsl.illuminance %p normal %p cos %x {
    rtsl.yield
  }
  rtsl.return
}
