// No function returns a vector of bools: LLVM's FastISel cannot take a `<4 x i1>` from a call on processors with AVX-512.
// RUN: rtsl-opt %s --rtsl-to-llvm | FileCheck %s
// RUN: rtsl-opt %s --rtsl-to-llvm | mlir-translate --mlir-to-llvmir | llc -O0 -mtriple=x86_64 -mcpu=x86-64-v4 -o - | FileCheck %s --check-prefix=ASM

// ASM-LABEL: A.use:
// ASM: callq A.compare

// CHECK-LABEL: llvm.func @A.compare(
// CHECK-SAME: -> vector<4xi32>
// CHECK: %[[BITS:.*]] = llvm.fcmp "olt"
// CHECK: %[[WIDE:.*]] = llvm.zext %[[BITS]] : vector<4xi1> to vector<4xi32>
// CHECK: llvm.return %[[WIDE]]
func.func @A.compare(%a: vector<4xf32>, %b: vector<4xf32>) -> vector<4xi1> {
  %less = arith.cmpf olt, %a, %b : vector<4xf32>
  return %less : vector<4xi1>
}
// CHECK-LABEL: llvm.func @A.use(
// CHECK: %[[CALLED:.*]] = llvm.call @A.compare({{.*}} -> vector<4xi32>
// CHECK: %[[BOOLS:.*]] = llvm.trunc %[[CALLED]] : vector<4xi32> to vector<4xi1>
// CHECK: ^bb1:
// CHECK: llvm.select %[[BOOLS]]
func.func @A.use(%a: vector<4xf32>, %b: vector<4xf32>) -> vector<4xf32> {
  %less = func.call @A.compare(%a, %b) : (vector<4xf32>, vector<4xf32>) -> vector<4xi1>
  cf.br ^bb1
^bb1:
  %least = arith.select %less, %a, %b : vector<4xi1>, vector<4xf32>
  return %least : vector<4xf32>
}
