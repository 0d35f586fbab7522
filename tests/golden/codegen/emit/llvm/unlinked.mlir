// What linking should have supplied is reported.
// RUN: rtsl-opt %s --rtsl-to-llvm -split-input-file -verify-diagnostics

func.func @f() {
  // expected-error @below {{attribute `n` has no `offset`: linking has not set it}}
  %p = rtsl.attribute "n" : !rtsl.ptr<f32>
  return
}

// -----

func.func @f(%t: !rtsl.ref<"rt_Texture">) {
  // expected-error @below {{`lookup` is a dispatch slot that linking has not resolved}}
  rtsl.call_method "lookup" on %t() : !rtsl.ref<"rt_Texture">, () -> ()
  return
}

// -----

func.func @f() {
  // expected-error @below {{is of level 1; run `rtsl-to-cf` first}}
  rtsl.return
}
