// RUN: rtsl-opt %s --rtsl-insert-suspends --rtsl-rematerialise --rtsl-save-live --rtsl-layout-frame --rtsl-split-states \
// RUN:   --split-input-file -verify-diagnostics

// expected-error @below {{`f` traces and returns a value, so it cannot be split into states}}
func.func @f(%o: vector<3xf32>) -> vector<3xf32> {
  %c = rtsl.trace %o, %o : vector<3xf32>
  return %c : vector<3xf32>
}

// -----

// After the trace, the address of a caller's argument is unknown.
func.func @f(%o: vector<3xf32>, %p: !rtsl.ptr<f32>) {
  // expected-error @below {{the address `argument` is used after a trace and cannot be recomputed there}}
  %c = rtsl.trace %o, %o : vector<3xf32>
  %x = vector.extract %c[0] : f32 from vector<3xf32>
  rtsl.store %x, %p : !rtsl.ptr<f32>
  return
}

// -----

func.func @f(%o: vector<3xf32>) {
  // expected-error @below {{resumes at a block that does not begin with `rtsl.trace_result`}}
  rtsl.suspend %o, %o, ^resume
^resume:
  return
}

// -----

func.func @f(%o: vector<3xf32>, %w: f32) {
  // expected-error @below {{saves 1 values and names 0}}
  rtsl.suspend %o, %o, ^resume(%w : f32)
^resume(%v: f32):
  %c = rtsl.trace_result : vector<3xf32>
  return
}

// -----

func.func @f() {
  // expected-error @below {{accesses byte 2, which is not a multiple of 4}}
  %w = rtsl.frame_load "w"[2] : f32
  return
}

// -----

func.func @f() {
  // expected-error @below {{has a bit exactly if the value is a bool}}
  %w = rtsl.frame_load "w"[0] : i1
  return
}

// -----

func.func @f() {
  // expected-error @below {{names a state exactly if it is a `trace` or a `jump`}}
  %n = rtsl.next done @g
  return
}
