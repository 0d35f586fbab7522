//===- FoldKnownCalls.h - elementary functions of constants ---------------===//
//
// Those that the IR has as operations are folded there (codegen/ir/dialect/RtslFolds.cpp). Unrolled
// loops have more of them. LLVM does not see that such a call has a constant result, because the
// functions are too large to be inlined.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "llvm/IR/PassManager.h"

namespace rtsl::codegen {

/// Replaces calls of the functions of math/ElementaryFunctions.def, and of their approximations for
/// `--fp=fast`, with constants by the correctly rounded results.
struct FoldKnownCallsPass : llvm::PassInfoMixin<FoldKnownCallsPass> {
  llvm::PreservedAnalyses run(llvm::Function &function, llvm::FunctionAnalysisManager &analyses);
};

} // namespace rtsl::codegen
