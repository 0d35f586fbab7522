//===- DivideZeros.cpp - differences that are 0, divided on a GPU ---------===//
#include "codegen/emit/rewrites/DivideZeros.h"

#include "llvm/IR/IRBuilder.h"
#include "llvm/IR/InstIterator.h"
#include "llvm/IR/PatternMatch.h"

namespace rtsl::codegen {

/// An IEEE division of a difference, or of a sum.
static bool mayOftenDivideZero(const llvm::Instruction &instruction) {
  using namespace llvm::PatternMatch;
  return instruction.getType()->isFloatTy() && !instruction.hasApproxFunc() &&
         !instruction.hasAllowReciprocal() &&
         (match(&instruction, m_FDiv(m_FSub(m_Value(), m_Value()), m_Value())) ||
          match(&instruction, m_FDiv(m_FAdd(m_Value(), m_Value()), m_Value())));
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
