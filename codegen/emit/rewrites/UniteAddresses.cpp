//===- UniteAddresses.cpp - the same address on all paths -----------------===//
#include "codegen/emit/rewrites/UniteAddresses.h"

#include "codegen/emit/rewrites/ChosenValues.h"

#include "llvm/IR/DataLayout.h"
#include "llvm/IR/IRBuilder.h"
#include "llvm/IR/InstIterator.h"
#include "llvm/IR/Instructions.h"
#include "llvm/IR/Module.h"

#include <optional>

namespace rtsl::codegen {

namespace {

/// An offset in a local variable.
struct VariableOffset {
  llvm::AllocaInst *variable = nullptr;
  std::int64_t offset = 0;
};

std::optional<VariableOffset> offsetInVariable(llvm::Value *pointer,
                                               const llvm::DataLayout &layout) {
  llvm::APInt offset(layout.getIndexTypeSizeInBits(pointer->getType()), 0);
  auto *variable = llvm::dyn_cast<llvm::AllocaInst>(
      pointer->stripAndAccumulateConstantOffsets(layout, offset, /*AllowNonInbounds=*/true));
  if (!variable || !variable->isStaticAlloca())
    return std::nullopt;
  return VariableOffset{variable, offset.getSExtValue()};
}

/// The one address that a phi node may have, through other phi nodes and selects.
std::optional<VariableOffset> onlyAddress(llvm::PHINode &phi, const llvm::DataLayout &layout) {
  std::optional<VariableOffset> only;
  const bool isOne = visitChosenValues({&phi}, [&](llvm::Value *value) {
    const auto found = offsetInVariable(value, layout);
    if (!found || (only && (only->variable != found->variable || only->offset != found->offset)))
      return false;
    only = found;
    return true;
  });
  return isOne ? only : std::nullopt;
}

} // namespace

llvm::PreservedAnalyses UniteAddressesPass::run(llvm::Function &function,
                                                llvm::FunctionAnalysisManager &) {
  const llvm::DataLayout &layout = function.getParent()->getDataLayout();
  llvm::SmallVector<llvm::PHINode *> phis;
  for (llvm::Instruction &instruction : llvm::instructions(function))
    if (auto *phi = llvm::dyn_cast<llvm::PHINode>(&instruction);
        phi && phi->getType()->isPointerTy())
      phis.push_back(phi);
  bool changed = false;
  for (llvm::PHINode *phi : phis)
    if (const auto address = onlyAddress(*phi, layout)) {
      llvm::IRBuilder<> builder(address->variable->getNextNode());
      phi->replaceAllUsesWith(
          builder.CreatePtrAdd(address->variable, builder.getInt64(address->offset)));
      phi->eraseFromParent();
      changed = true;
    }
  return changed ? llvm::PreservedAnalyses::none() : llvm::PreservedAnalyses::all();
}

} // namespace rtsl::codegen
