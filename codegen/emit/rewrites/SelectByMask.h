//===- SelectByMask.h - floats selected with a mask of AVX-512 ------------===//
//
// With AVX-512, LLVM 22 computes a comparison of floats that decides several selects in the flags,
// and moves it to a mask register by way of a general register:
//
//   vucomiss, seta, kmovd, vmovss {k1}, vmovss {k1}   instead of   vcmpltps, vmovaps {k1}, ...
//
// So such a comparison and its selects become those of vectors of which one number matters: that
// comparison writes the mask.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "llvm/IR/PassManager.h"

namespace rtsl::codegen {

/// Rewrites comparisons that are used by two or more selects of floats in their own block, and by
/// nothing else. A select of the smaller or larger of two compared numbers is one instruction
/// already: such a comparison stays. The last pass, because LLVM's simplification would reverse it.
struct SelectByMaskPass : llvm::PassInfoMixin<SelectByMaskPass> {
  llvm::PreservedAnalyses run(llvm::Function &function, llvm::FunctionAnalysisManager &analyses);
};

} // namespace rtsl::codegen
