//===- SelectByMask.cpp - floats selected with a mask of AVX-512 ----------===//
#include "codegen/emit/rewrites/SelectByMask.h"

#include "llvm/IR/IRBuilder.h"
#include "llvm/IR/InstIterator.h"

namespace rtsl::codegen {

namespace {

/// Is it the smaller or the larger of the numbers that are compared?
bool isOneOfCompared(const llvm::SelectInst &select, const llvm::FCmpInst &comparison) {
  const llvm::Value *a = comparison.getOperand(0), *b = comparison.getOperand(1);
  const llvm::Value *yes = select.getTrueValue(), *no = select.getFalseValue();
  return (yes == a && no == b) || (yes == b && no == a);
}

/// Whether `user` selects other floats by this comparison, in its block.
bool selectsFloats(const llvm::User *user, const llvm::FCmpInst &comparison) {
  const auto *select = llvm::dyn_cast<llvm::SelectInst>(user);
  return select && select->getType()->isFloatTy() &&
         select->getParent() == comparison.getParent() && !isOneOfCompared(*select, comparison);
}

bool shouldWriteMask(const llvm::Instruction &instruction) {
  const auto *comparison = llvm::dyn_cast<llvm::FCmpInst>(&instruction);
  return comparison && comparison->getOperand(0)->getType()->isFloatTy() &&
         comparison->hasNUsesOrMore(2) && llvm::all_of(comparison->users(), [&](auto *user) {
           return selectsFloats(user, *comparison);
         });
}

/// A vector that fills a register, with this number in the first place, and any in the others.
llvm::Value *widen(llvm::IRBuilder<> &builder, llvm::Value *number) {
  auto *vector = llvm::FixedVectorType::get(number->getType(), 4);
  return builder.CreateInsertElement(llvm::PoisonValue::get(vector), number, builder.getInt32(0));
}

void selectByMask(llvm::FCmpInst &comparison) {
  llvm::IRBuilder<> builder(&comparison);
  llvm::Value *mask =
      builder.CreateFCmp(comparison.getPredicate(), widen(builder, comparison.getOperand(0)),
                         widen(builder, comparison.getOperand(1)));
  for (llvm::User *user : llvm::make_early_inc_range(comparison.users())) {
    auto *select = llvm::cast<llvm::SelectInst>(user);
    builder.SetInsertPoint(select);
    llvm::Value *chosen = builder.CreateSelect(mask, widen(builder, select->getTrueValue()),
                                               widen(builder, select->getFalseValue()));
    select->replaceAllUsesWith(builder.CreateExtractElement(chosen, builder.getInt32(0)));
    select->eraseFromParent();
  }
  comparison.eraseFromParent();
}

} // namespace

llvm::PreservedAnalyses SelectByMaskPass::run(llvm::Function &function,
                                              llvm::FunctionAnalysisManager &) {
  llvm::SmallVector<llvm::FCmpInst *> comparisons;
  for (llvm::Instruction &instruction : llvm::instructions(function))
    if (shouldWriteMask(instruction))
      comparisons.push_back(llvm::cast<llvm::FCmpInst>(&instruction));
  for (llvm::FCmpInst *comparison : comparisons)
    selectByMask(*comparison);
  return comparisons.empty() ? llvm::PreservedAnalyses::all() : llvm::PreservedAnalyses::none();
}

} // namespace rtsl::codegen
