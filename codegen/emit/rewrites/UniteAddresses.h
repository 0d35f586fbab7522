//===- UniteAddresses.h - the same address on all paths -------------------===//
//
// The current ray has the address of its payload; before it was sent, it has none. If all paths
// have the same address in one variable, or none, LLVM leaves phi nodes of it in a loop, and the
// variable in memory. This pass replaces the phi nodes by the address, so that SROA can promote the
// variable.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "llvm/IR/PassManager.h"

namespace rtsl::codegen {

struct UniteAddressesPass : llvm::PassInfoMixin<UniteAddressesPass> {
  llvm::PreservedAnalyses run(llvm::Function &function, llvm::FunctionAnalysisManager &analyses);
};

} // namespace rtsl::codegen
