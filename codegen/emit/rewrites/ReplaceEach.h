//===- ReplaceEach.h - a rewrite of single instructions -------------------===//
#pragma once

#include "llvm/IR/InstIterator.h"
#include "llvm/IR/Instructions.h"
#include "llvm/IR/PassManager.h"

namespace rtsl::codegen {

/// Replaces each instruction of a function by replacement(instruction), in their order, unless that
/// is null. True if there was one. The replacement may insert instructions before its own, but
/// leaves the blocks as they are.
template <typename Replacement>
bool replaceEach(llvm::Function &function, Replacement replacement) {
  bool changed = false;
  for (llvm::Instruction &instruction : llvm::make_early_inc_range(llvm::instructions(function)))
    if (llvm::Value *value = replacement(instruction)) {
      instruction.replaceAllUsesWith(value);
      instruction.eraseFromParent();
      changed = true;
    }
  return changed;
}

/// What a pass preserves that only replaces instructions.
inline llvm::PreservedAnalyses preservedBy(bool changed) {
  if (!changed)
    return llvm::PreservedAnalyses::all();
  llvm::PreservedAnalyses preserved;
  preserved.preserveSet<llvm::CFGAnalyses>();
  return preserved;
}

} // namespace rtsl::codegen
