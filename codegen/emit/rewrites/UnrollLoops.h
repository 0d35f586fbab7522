//===- UnrollLoops.h - loops whose values are known when compiling --------===//
//
// A short loop may compute sines and powers of nothing but its counter: the directions of lamps
// around a circle, the weights of octaves. Unrolled, they are constants. Likewise a local array
// that the counter indexes: unrolled, its elements are values, which a GPU keeps in registers.
// LLVM, which unrolls by size and after it has inlined, sees neither: the functions are larger than
// what it allows.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "llvm/IR/PassManager.h"

namespace rtsl::codegen {

/// Unrolls these loops completely. Before functions are inlined.
struct UnrollLoopsPass : llvm::PassInfoMixin<UnrollLoopsPass> {
  llvm::PreservedAnalyses run(llvm::Function &function, llvm::FunctionAnalysisManager &analyses);
};

} // namespace rtsl::codegen
