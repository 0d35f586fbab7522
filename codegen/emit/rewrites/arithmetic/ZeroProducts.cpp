//===- ZeroProducts.cpp - products with a constant zero -------------------===//
#include "codegen/emit/rewrites/arithmetic/ZeroProducts.h"

#include "codegen/emit/rewrites/ReplaceEach.h"

#include "llvm/IR/Operator.h"
#include "llvm/IR/PatternMatch.h"

namespace rtsl::codegen {

using namespace llvm::PatternMatch;

/// The runtime's code, which is strict, has none of these flags.
static bool isOfShader(const llvm::Instruction &instruction) {
  return instruction.hasAllowReassoc() && instruction.hasNoSignedZeros();
}

/// The zero that takes the place of an instruction; null: it stays.
static llvm::Value *zeroFor(llvm::Instruction &product) {
  llvm::Constant *zero = nullptr;
  return match(&product, m_c_FMul(m_Value(), m_Constant(zero))) && match(zero, m_AnyZeroFP()) &&
                 isOfShader(product)
             ? zero
             : nullptr;
}

llvm::PreservedAnalyses ZeroProductsPass::run(llvm::Function &function,
                                              llvm::FunctionAnalysisManager &) {
  return preservedBy(replaceEach(function, zeroFor));
}

} // namespace rtsl::codegen
