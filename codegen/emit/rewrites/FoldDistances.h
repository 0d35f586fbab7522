//===- FoldDistances.h - distances of addresses from a variable -----------===//
//
// The record of a sample in flight has addresses as distances from the stack of its rays
// (runtime/device/organisations/LaneRecord.h). LLVM does not subtract the address of a variable
// from a phi node of addresses in it, so that the variable would have to be in memory. This pass
// replaces such a difference by a phi node of distances.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "llvm/IR/PassManager.h"

namespace rtsl::codegen {

struct FoldDistancesPass : llvm::PassInfoMixin<FoldDistancesPass> {
  llvm::PreservedAnalyses run(llvm::Function &function, llvm::FunctionAnalysisManager &analyses);
};

} // namespace rtsl::codegen
