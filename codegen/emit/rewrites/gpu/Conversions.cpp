//===- Conversions.cpp - floats to integers on a GPU -------------------===//
#include "codegen/emit/rewrites/gpu/Conversions.h"

#include "codegen/emit/rewrites/ReplaceEach.h"

#include "llvm/IR/IRBuilder.h"
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

static llvm::Value *inPtx(llvm::Instruction &instruction) {
  const auto *conversion = llvm::dyn_cast<llvm::IntrinsicInst>(&instruction);
  const llvm::Intrinsic::ID id =
      conversion ? instructionFor(*conversion) : llvm::Intrinsic::not_intrinsic;
  return id != llvm::Intrinsic::not_intrinsic
             ? llvm::IRBuilder<>(&instruction).CreateIntrinsic(id, {conversion->getArgOperand(0)})
             : nullptr;
}

llvm::PreservedAnalyses ConversionsPass::run(llvm::Function &function,
                                             llvm::FunctionAnalysisManager &) {
  return preservedBy(replaceEach(function, inPtx));
}

} // namespace rtsl::codegen
