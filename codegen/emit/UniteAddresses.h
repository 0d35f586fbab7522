//===- UniteAddresses.h - the same address on all paths -------------------===//
//
// The current ray has the address of its payload, and none before it was sent. Where all paths
// bring the same place in one variable, or nothing, LLVM leaves phi nodes of it in a loop, and the
// variable in memory. This pass puts the place there instead, so that SROA can make values of what
// lies in it.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "llvm/IR/PassManager.h"

namespace rtsl::codegen {

struct UniteAddressesPass : llvm::PassInfoMixin<UniteAddressesPass> {
  llvm::PreservedAnalyses run(llvm::Function &function, llvm::FunctionAnalysisManager &analyses);
};

} // namespace rtsl::codegen
