//===- ChosenValues.h - what phi nodes and selects choose from ------------===//
#pragma once

#include "llvm/ADT/STLFunctionalExtras.h"
#include "llvm/ADT/SmallPtrSet.h"
#include "llvm/ADT/SmallVector.h"
#include "llvm/IR/Constants.h"
#include "llvm/IR/Instructions.h"

namespace rtsl::codegen {

/// Calls visit(value) for everything that the values may be, through phi nodes and selects: once
/// for each value that is neither of these, nor undefined. Ends, and returns false, if visit does.
inline bool visitChosenValues(llvm::SmallVector<llvm::Value *> values,
                              llvm::function_ref<bool(llvm::Value *)> visit) {
  llvm::SmallPtrSet<llvm::Value *, 16> seen;
  while (!values.empty()) {
    llvm::Value *value = values.pop_back_val();
    if (!seen.insert(value).second || llvm::isa<llvm::UndefValue>(value))
      continue;
    if (auto *phi = llvm::dyn_cast<llvm::PHINode>(value))
      values.append(phi->value_op_begin(), phi->value_op_end());
    else if (auto *select = llvm::dyn_cast<llvm::SelectInst>(value))
      values.append({select->getTrueValue(), select->getFalseValue()});
    else if (!visit(value))
      return false;
  }
  return true;
}

} // namespace rtsl::codegen
