//===- DivideZeros.cpp - differences that are 0, divided on a GPU ---------===//
#include "codegen/emit/rewrites/gpu/DivideZeros.h"

#include "llvm/IR/IRBuilder.h"
#include "llvm/IR/InstIterator.h"
#include "llvm/IR/PatternMatch.h"

namespace rtsl::codegen {

using namespace llvm::PatternMatch;

/// A sum of squares, as that of a dot product of a vector with itself.
static bool isSumOfSquares(const llvm::Value *value) {
  const llvm::Value *a = nullptr, *b = nullptr;
  if (match(value, m_FMul(m_Value(a), m_Deferred(a))))
    return true;
  return match(value, m_FAdd(m_Value(a), m_Value(b))) && isSumOfSquares(a) && isSumOfSquares(b);
}

/// An IEEE division of a difference, or of a sum that may be one.
static bool mayOftenDivideZero(const llvm::Instruction &instruction) {
  const llvm::Value *numerator = nullptr;
  if (!instruction.getType()->isFloatTy() || instruction.hasApproxFunc() ||
      instruction.hasAllowReciprocal() ||
      !match(&instruction, m_FDiv(m_Value(numerator), m_Value())))
    return false;
  return match(numerator, m_FSub(m_Value(), m_Value())) ||
         (match(numerator, m_FAdd(m_Value(), m_Value())) && !isSumOfSquares(numerator));
}

static void selectZeros(llvm::Instruction &division) {
  llvm::IRBuilder<> builder(&division);
  llvm::Value *numerator = division.getOperand(0), *divisor = division.getOperand(1);
  llvm::Value *zero = llvm::ConstantFP::getZero(division.getType());
  llvm::Value *isZero = builder.CreateAnd(builder.CreateFCmpOEQ(numerator, zero),
                                          builder.CreateFCmpONE(divisor, zero));
  auto bits = [&](llvm::Value *value) {
    return builder.CreateBitCast(value, builder.getInt32Ty());
  };
  llvm::Value *sign = builder.CreateAnd(builder.CreateXor(bits(numerator), bits(divisor)),
                                        builder.getInt32(0x80000000));
  llvm::Value *quotient =
      builder.CreateFDiv(builder.CreateSelect(isZero, divisor, numerator), divisor);
  division.replaceAllUsesWith(
      builder.CreateSelect(isZero, builder.CreateBitCast(sign, division.getType()), quotient));
  division.eraseFromParent();
}

llvm::PreservedAnalyses DivideZerosPass::run(llvm::Function &function,
                                             llvm::FunctionAnalysisManager &) {
  bool changed = false;
  for (llvm::Instruction &instruction : llvm::make_early_inc_range(llvm::instructions(function)))
    if (mayOftenDivideZero(instruction)) {
      selectZeros(instruction);
      changed = true;
    }
  return changed ? llvm::PreservedAnalyses::none() : llvm::PreservedAnalyses::all();
}

} // namespace rtsl::codegen
