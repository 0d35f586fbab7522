//===- Approximations.cpp - division and square root on a GPU -------------===//
#include "codegen/emit/rewrites/gpu/Approximations.h"

#include "codegen/emit/rewrites/ReplaceEach.h"

#include "llvm/IR/IRBuilder.h"
#include "llvm/IR/IntrinsicsNVPTX.h"
#include "llvm/IR/PatternMatch.h"

namespace rtsl::codegen {

using namespace llvm::PatternMatch;

static bool mayBeApproximate(const llvm::Instruction &instruction) {
  return instruction.getType()->isFloatTy() && llvm::isa<llvm::FPMathOperator>(instruction) &&
         instruction.hasAllowReciprocal();
}

static llvm::Value *approximateRoot(llvm::Instruction &root) {
  llvm::Value *square = nullptr;
  if (!mayBeApproximate(root) || !match(&root, m_Sqrt(m_Value(square))))
    return nullptr;
  return llvm::IRBuilder<>(&root).CreateIntrinsic(llvm::Intrinsic::nvvm_sqrt_approx_f, {square});
}

static llvm::Value *approximateQuotient(llvm::Instruction &division) {
  llvm::Value *a = nullptr, *b = nullptr, *square = nullptr;
  if (!mayBeApproximate(division) || !match(&division, m_FDiv(m_Value(a), m_Value(b))))
    return nullptr;
  llvm::IRBuilder<> builder(&division);
  builder.setFastMathFlags(division.getFastMathFlags());
  auto *root = llvm::dyn_cast<llvm::Instruction>(b);
  if (!root || !mayBeApproximate(*root) || !match(root, m_Sqrt(m_Value(square))))
    return builder.CreateFMul(a,
                              builder.CreateIntrinsic(llvm::Intrinsic::nvvm_rcp_approx_ftz_f, {b}));
  return builder.CreateFMul(
      a, builder.CreateIntrinsic(llvm::Intrinsic::nvvm_rsqrt_approx_f, {square}));
}

llvm::PreservedAnalyses ApproximationsPass::run(llvm::Function &function,
                                                llvm::FunctionAnalysisManager &) {
  bool changed = replaceEach(function, approximateQuotient); // first, by roots that are roots still
  changed |= replaceEach(function, approximateRoot);
  return preservedBy(changed);
}

} // namespace rtsl::codegen
