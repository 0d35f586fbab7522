// What LLVM might take for a function of the C library is called otherwise; exports keep their names.
// RUN: rtsl-opt %s --rtsl-to-llvm | FileCheck %s

// CHECK-LABEL: llvm.func @rtsl_entry(%arg0: !llvm.ptr {{{.*}}}) attributes {no_unwind} {
// CHECK-NEXT: llvm.call @function.free(%arg0)
// CHECK-NEXT: llvm.call @f.vec3(%arg0)
func.func @rtsl_entry() attributes {rtsl.export} {
  func.call @free() : () -> ()
  func.call @f.vec3() : () -> ()
  return
}
// CHECK: llvm.func @function.free(
func.func private @free() {
  return
}
// CHECK: llvm.func @f.vec3(
func.func private @f.vec3() {
  return
}
