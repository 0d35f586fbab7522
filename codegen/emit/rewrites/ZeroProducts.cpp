//===- ZeroProducts.cpp - products with a constant zero -------------------===//
#include "codegen/emit/rewrites/ZeroProducts.h"

#include "llvm/IR/InstIterator.h"
#include "llvm/IR/Instructions.h"
#include "llvm/IR/Operator.h"
#include "llvm/IR/PatternMatch.h"

namespace rtsl::codegen {

using namespace llvm::PatternMatch;

/// The runtime's code, which is strict, has none of these flags.
static bool isOfShader(const llvm::Instruction &instruction) {
  return instruction.hasAllowReassoc() && instruction.hasNoSignedZeros();
}

llvm::PreservedAnalyses ZeroProductsPass::run(llvm::Function &function,
                                              llvm::FunctionAnalysisManager &) {
  bool changed = false;
  for (llvm::Instruction &product : llvm::make_early_inc_range(llvm::instructions(function))) {
    llvm::Constant *zero = nullptr;
    if (!match(&product, m_c_FMul(m_Value(), m_Constant(zero))) || !match(zero, m_AnyZeroFP()) ||
        !isOfShader(product))
      continue;
    product.replaceAllUsesWith(zero);
    product.eraseFromParent();
    changed = true;
  }
  if (!changed)
    return llvm::PreservedAnalyses::all();
  llvm::PreservedAnalyses preserved;
  preserved.preserveSet<llvm::CFGAnalyses>();
  return preserved;
}

} // namespace rtsl::codegen
