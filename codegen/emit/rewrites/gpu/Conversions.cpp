//===- Conversions.cpp - floats to integers on a GPU -------------------===//
#include "codegen/emit/rewrites/gpu/Conversions.h"

#include "llvm/IR/IRBuilder.h"
#include "llvm/IR/InstIterator.h"
#include "llvm/IR/IntrinsicInst.h"
#include "llvm/IR/IntrinsicsNVPTX.h"

namespace rtsl::codegen {

/// The instruction of PTX for a conversion from float to 32 bits; 0: none.
static llvm::Intrinsic::ID instructionFor(const llvm::IntrinsicInst &conversion) {
  const llvm::Intrinsic::ID id = conversion.getIntrinsicID();
  if (id != llvm::Intrinsic::fptosi_sat && id != llvm::Intrinsic::fptoui_sat)
    return llvm::Intrinsic::not_intrinsic;
  if (!conversion.getType()->isIntegerTy(32) ||
      !conversion.getArgOperand(0)->getType()->isFloatTy())
    return llvm::Intrinsic::not_intrinsic;
  return id == llvm::Intrinsic::fptosi_sat ? llvm::Intrinsic::nvvm_f2i_rz
                                           : llvm::Intrinsic::nvvm_f2ui_rz;
}

llvm::PreservedAnalyses ConversionsPass::run(llvm::Function &function,
                                             llvm::FunctionAnalysisManager &) {
  bool changed = false;
  for (llvm::Instruction &instruction : llvm::make_early_inc_range(llvm::instructions(function))) {
    auto *conversion = llvm::dyn_cast<llvm::IntrinsicInst>(&instruction);
    const llvm::Intrinsic::ID id =
        conversion ? instructionFor(*conversion) : llvm::Intrinsic::not_intrinsic;
    if (id == llvm::Intrinsic::not_intrinsic)
      continue;
    llvm::IRBuilder<> builder(conversion);
    conversion->replaceAllUsesWith(builder.CreateIntrinsic(id, {conversion->getArgOperand(0)}));
    conversion->eraseFromParent();
    changed = true;
  }
  return changed ? llvm::PreservedAnalyses::none() : llvm::PreservedAnalyses::all();
}

} // namespace rtsl::codegen
