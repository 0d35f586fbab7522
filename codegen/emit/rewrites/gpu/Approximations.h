//===- Approximations.h - division and square root on a GPU ---------------===//
//
// A GPU has instructions that approximate 1/x and 1/sqrt(x); the nearest float takes twelve more
// and a branch. With --fp=fast the code of shaders uses them. Infinities and NaNs stay what they
// are; of the divisors subnormal ones count as 0, and those above 2^126 as infinite ("rcp", "sqrt"
// and "rsqrt" in the manual of PTX). The bounds in units in the last place were measured
// (docs/fast.md).
//
//   fdiv fast %a, %b             =>  %a times rcp.approx.ftz of %b  3 units
//   fdiv fast %a, (sqrt fast %b) =>  %a times rsqrt.approx of %b    3
//   sqrt fast %a                 =>  sqrt.approx                    1
//
// "fast" stands for the flags of FastMath.h, which no code of the runtime has.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "llvm/IR/PassManager.h"

namespace rtsl::codegen {

struct ApproximationsPass : llvm::PassInfoMixin<ApproximationsPass> {
  llvm::PreservedAnalyses run(llvm::Function &function, llvm::FunctionAnalysisManager &analyses);
};

} // namespace rtsl::codegen
