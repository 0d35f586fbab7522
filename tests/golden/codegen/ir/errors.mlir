// What the verifiers say.
// RUN: rtsl-opt %s -split-input-file -verify-diagnostics

// expected-error @below {{has root "Material", which is not an `rt_` class}}
rtsl.class @Glass root "Material" {
}

// -----

rtsl.class @Glass root "rt_Material" {
  // expected-error @below {{has access "protected"; expected "public", "private" or "scratch"}}
  rtsl.member_decl @eta : f32 access "protected"
}

// -----

rtsl.class @Glass root "rt_Material" {
  // expected-error @below {{has type 'f64', which cannot be stored in memory}}
  rtsl.member_decl @eta : f64 access "public"
}

// -----

rtsl.class @Glass root "rt_Material" {
  rtsl.member_decl @eta : f32 access "public"
  rtsl.member_decl @n : vector<3xf32> access "scratch"
}
func.func @unknown(%self: !rtsl.ref<"Glass">) {
  // expected-error @below {{names member "etta", which class `Glass` does not have}}
  %p = rtsl.member %self["etta"] : !rtsl.ref<"Glass"> -> !rtsl.ptr<f32>
  rtsl.return
}

// -----

rtsl.class @Glass root "rt_Material" {
  rtsl.member_decl @eta : f32 access "public"
  rtsl.member_decl @n : vector<3xf32> access "scratch"
}
func.func @type(%self: !rtsl.ref<"Glass">) {
  // expected-error @below {{gives '!rtsl.ptr<f32>', not '!rtsl.ptr<i32>'}}
  %p = rtsl.member %self["eta"] : !rtsl.ref<"Glass"> -> !rtsl.ptr<i32>
  rtsl.return
}

// -----

rtsl.class @Glass root "rt_Material" {
  rtsl.member_decl @eta : f32 access "public"
  rtsl.member_decl @n : vector<3xf32> access "scratch"
}
func.func @scratch(%self: !rtsl.ref<"Glass">) {
  // expected-error @below {{names the scratch member "n", which is not in the record; use `rtsl.attribute`}}
  %p = rtsl.member %self["n"] : !rtsl.ref<"Glass"> -> !rtsl.ptr<vector<3xf32>>
  rtsl.return
}

// -----

rtsl.class @Glass root "rt_Material" {
  rtsl.member_decl @eta : f32 access "public"
  rtsl.member_decl @n : vector<3xf32> access "scratch"
}
func.func @noClass(%self: !rtsl.ref<"Clay">) {
  // expected-error @below {{needs class `Clay`, which no `rtsl.class` declares}}
  %p = rtsl.member %self["eta"] : !rtsl.ref<"Clay"> -> !rtsl.ptr<f32>
  rtsl.return
}

// -----

// expected-error @below {{the pointee cannot be 'i64': memory holds f32, i32, i1}}
func.func private @f(!rtsl.ptr<i64>)

// -----

// expected-error @below {{a buffer has 1 to 3 dimensions, not 4}}
!b = !rtsl.buffer<f32, 4>

// -----

// expected-error @below {{struct `S` has two fields called `a`}}
!s = !rtsl.struct<"S", {a: f32, a: i32}>

// -----

// expected-error @below {{an array has at least one element}}
!a = !rtsl.array<0 x f32>

// -----

func.func @f(%p: !rtsl.ptr<!rtsl.struct<"S", {a: f32}>>) {
  // expected-error @below {{names field "b", which struct `S` does not have}}
  %b = rtsl.field %p["b"] : !rtsl.ptr<!rtsl.struct<"S", {a: f32}>> -> !rtsl.ptr<f32>
  rtsl.return
}

// -----

func.func @f(%p: !rtsl.ptr<!rtsl.array<2 x f32>>, %i: i32) {
  // expected-error @below {{gives '!rtsl.ptr<f32>', not '!rtsl.ptr<i32>'}}
  %b = rtsl.element %p[%i] : !rtsl.ptr<!rtsl.array<2 x f32>> -> !rtsl.ptr<i32>
  rtsl.return
}

// -----

func.func @f(%p: !rtsl.ptr<!rtsl.array<2 x f32>>) {
  // expected-error @below {{must be the address of a scalar, a vector or a reference}}
  %b = "rtsl.load"(%p) : (!rtsl.ptr<!rtsl.array<2 x f32>>) -> f32
  rtsl.return
}

// -----

func.func @f() {
  // expected-error @below {{names "rt_RayOrigin", which is not a state variable; leave out `rt_`}}
  %p = rtsl.state "rt_RayOrigin" : !rtsl.ptr<vector<3xf32>>
  rtsl.return
}

// -----

func.func @f() {
  // expected-error @below {{gives '!rtsl.ptr<f32>', not '!rtsl.ptr<i32>'}}
  %p = rtsl.state "Epsilon" : !rtsl.ptr<i32>
  rtsl.return
}

// -----

func.func @f() {
  // expected-error @below {{must give a color for "SampleColor", not 'f32'}}
  %q = rtsl.state "SampleColor" : !rtsl.ptr<f32>
  rtsl.return
}

// -----

func.func @f(%b: !rtsl.ptr<!rtsl.buffer<f32, 2>>, %i: i32) {
  // expected-error @below {{has 1 indices for 2 dimensions}}
  %e = rtsl.buffer_element %b[%i] : !rtsl.ptr<!rtsl.buffer<f32, 2>> -> !rtsl.ptr<f32>
  rtsl.return
}

// -----

func.func @f(%b: !rtsl.ptr<!rtsl.buffer<f32, 2>>) {
  // expected-error @below {{queries dimension 2 of 2}}
  %n = rtsl.buffer_length %b, 2 : !rtsl.ptr<!rtsl.buffer<f32, 2>>
  rtsl.return
}

// -----

func.func @f(%x: f32) {
  // expected-error @below {{<pow> takes 2 operands, not 1}}
  %p = rtsl.elementary <pow> %x : f32
  rtsl.return
}

// -----

func.func @f() {
  // expected-error @below {{is in no loop, illuminance or switch}}
  rtsl.break
}

// -----

func.func @f(%v: i32) {
  rtsl.switch %v : i32 {
    arm [1] {
      // expected-error @below {{is in no loop or illuminance}}
      rtsl.continue
    }
  }
  rtsl.return
}

// -----

func.func @f(%c: i1) {
  rtsl.loop cond {
    rtsl.if %c {
      // expected-error @below {{is in a loop's `cond` or `step`; it is only for the body}}
      rtsl.continue
    }
    rtsl.condition %c
  } do {
    rtsl.yield
  }
  rtsl.return
}

// -----

func.func @f(%c: i1) {
  // expected-error @below {{has a `cond` that does not end in `rtsl.condition`}}
  rtsl.loop cond {
    rtsl.yield
  } do {
    rtsl.yield
  }
  rtsl.return
}

// -----

func.func @f(%v: i32) {
  // expected-error @below {{lists the value 2 twice}}
  rtsl.switch %v : i32 {
    arm [1, 2] {
      rtsl.break
    }
    arm [2] {
      rtsl.break
    }
  }
  rtsl.return
}

// -----

func.func @f(%v: i32) {
  rtsl.switch %v : i32 {
    // expected-error @below {{expected the arm's values, `[...]`, or `default`}}
    arm {
      rtsl.break
    }
  }
  rtsl.return
}

// -----

func.func @f() -> f32 {
  // expected-error @below {{has no value; the function returns 'f32'}}
  rtsl.return
}

// -----

func.func @f(%x: f32) {
  // expected-error @below {{has values of type 'f32'; the function returns nothing}}
  rtsl.return %x : f32
}

// -----

// expected-error @below {{`rtsl.class` must be a string}}
func.func private @f() attributes {rtsl.class}

// -----

// expected-error @below {{has the attribute `rtsl.clas`, which the dialect does not declare}}
func.func private @f() attributes {rtsl.clas = "Glass"}

// -----

// expected-error @below {{`rtsl.export` takes no value}}
func.func private @f() attributes {rtsl.export = "f"}

// -----

// expected-error @below {{`rtsl.frame_size` must be an integer}}
func.func private @f() attributes {rtsl.frame_size = "16"}

// -----

// expected-error @below {{may not have `rtsl.join`, an attribute of rtsl.suspend}}
func.func private @f() attributes {rtsl.join}

// -----

func.func @f() {
  // expected-error @below {{may not have `rtsl.shared`, an attribute of rtsl.frame_load, rtsl.frame_store}}
  %x = arith.constant {rtsl.shared} 1.0 : f32
  return
}

// -----

func.func @f() {
  // expected-error @below {{has the attribute `rtsl.sahred`, which the dialect does not declare}}
  %x = rtsl.frame_load "x"[0] {rtsl.sahred} : f32
  return
}

// -----

func.func @f() {
  // expected-error @below {{has 1 words, and '!rtsl.array<2 x f32>' has 2}}
  %t = rtsl.table "t" [0] : !rtsl.ptr<!rtsl.array<2 x f32>>
  return
}

// -----

rtsl.class @A root "rt_Texture" {
}
func.func @f() {
  // expected-error @below {{may hold only numbers, not}}
  %t = rtsl.table "t" [0] : !rtsl.ptr<!rtsl.array<1 x !rtsl.ref<"A">>>
  return
}
