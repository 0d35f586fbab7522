//===- DivideZeros.h - differences that are 0, divided on a GPU -----------===//
//
// A GPU divides by a short sequence of instructions, except numbers that this would round wrongly;
// for these, and for 0, it calls a function. A difference is often exactly 0: the distance from a
// plane of a ray that starts on it, for which one lane then makes its warp wait. So the result for
// a zero difference is selected, and the division gets another dividend, for which it needs no
// call.
//
//   %q = fdiv float %difference, %b
//   =>
//   %isZero = and (fcmp oeq %difference, 0), (fcmp one %b, 0)
//   %q = fdiv float (select %isZero, %b, %difference), %b
//   %result = select %isZero, (0 with the sign of the quotient), %q
//
//===----------------------------------------------------------------------===//
#pragma once

#include "llvm/IR/PassManager.h"

namespace rtsl::codegen {

struct DivideZerosPass : llvm::PassInfoMixin<DivideZerosPass> {
  llvm::PreservedAnalyses run(llvm::Function &function, llvm::FunctionAnalysisManager &analyses);
};

} // namespace rtsl::codegen
