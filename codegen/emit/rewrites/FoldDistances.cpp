//===- FoldDistances.cpp - distances of addresses from a variable ---------===//
#include "codegen/emit/rewrites/FoldDistances.h"

#include "llvm/ADT/DenseMap.h"
#include "llvm/IR/IRBuilder.h"
#include "llvm/IR/InstIterator.h"
#include "llvm/IR/Instructions.h"
#include "llvm/IR/PatternMatch.h"

namespace rtsl::codegen {

namespace {

/// The distances of addresses from one variable, as values of type i64.
class Distances {
public:
  explicit Distances(llvm::AllocaInst &variable) : variable(variable) {}

  /// Whether the address is in the variable, or undefined, on all paths.
  bool isKnown(llvm::Value *address, unsigned depth = 0) {
    constexpr unsigned mostNested = 64;
    if (address == &variable || llvm::isa<llvm::UndefValue>(address) || phis.contains(address))
      return true;
    if (depth == mostNested)
      return false;
    if (auto *step = llvm::dyn_cast<llvm::GetElementPtrInst>(address))
      return isByteStep(*step) && isKnown(step->getPointerOperand(), depth + 1);
    if (auto *choice = llvm::dyn_cast<llvm::SelectInst>(address))
      return isKnown(choice->getTrueValue(), depth + 1) &&
             isKnown(choice->getFalseValue(), depth + 1);
    auto *phi = llvm::dyn_cast<llvm::PHINode>(address);
    if (!phi)
      return false;
    phis[phi] = nullptr;
    return llvm::all_of(phi->incoming_values(),
                        [&](llvm::Value *value) { return isKnown(value, depth + 1); });
  }

  /// The distance of an address that isKnown().
  llvm::Value *of(llvm::Value *address) {
    llvm::Type *type = llvm::Type::getInt64Ty(variable.getContext());
    if (address == &variable)
      return llvm::ConstantInt::get(type, 0);
    if (llvm::isa<llvm::UndefValue>(address))
      return llvm::UndefValue::get(type);
    if (auto *phi = llvm::dyn_cast<llvm::PHINode>(address))
      return ofPhi(*phi, *type);
    auto &instruction = *llvm::cast<llvm::Instruction>(address);
    llvm::IRBuilder<> builder(&instruction);
    if (auto *step = llvm::dyn_cast<llvm::GetElementPtrInst>(address))
      return builder.CreateAdd(of(step->getPointerOperand()),
                               builder.CreateSExtOrTrunc(*step->idx_begin(), type));
    auto &choice = *llvm::cast<llvm::SelectInst>(address);
    llvm::Value *yes = of(choice.getTrueValue()), *no = of(choice.getFalseValue());
    return builder.CreateSelect(choice.getCondition(), yes, no);
  }

private:
  static bool isByteStep(const llvm::GetElementPtrInst &step) {
    return step.getNumIndices() == 1 && step.getSourceElementType()->isIntegerTy(8);
  }

  llvm::Value *ofPhi(llvm::PHINode &phi, llvm::Type &type) {
    if (llvm::Value *made = phis[&phi])
      return made;
    llvm::IRBuilder<> builder(&phi);
    llvm::PHINode *distance = builder.CreatePHI(&type, phi.getNumIncomingValues());
    phis[&phi] = distance;
    for (unsigned i = 0; i < phi.getNumIncomingValues(); ++i)
      distance->addIncoming(of(phi.getIncomingValue(i)), phi.getIncomingBlock(i));
    return distance;
  }

  llvm::AllocaInst &variable;
  llvm::DenseMap<llvm::Value *, llvm::PHINode *> phis; // null: not made yet
};

} // namespace

llvm::PreservedAnalyses FoldDistancesPass::run(llvm::Function &function,
                                               llvm::FunctionAnalysisManager &) {
  using namespace llvm::PatternMatch;
  bool hasChanged = false;
  for (llvm::Instruction &instruction : llvm::make_early_inc_range(llvm::instructions(function))) {
    llvm::Value *address = nullptr, *begin = nullptr;
    if (!match(&instruction, m_Sub(m_PtrToInt(m_Value(address)), m_PtrToInt(m_Value(begin)))) ||
        !instruction.getType()->isIntegerTy(64))
      continue;
    auto *variable = llvm::dyn_cast<llvm::AllocaInst>(begin);
    if (!variable)
      continue;
    Distances distances(*variable);
    if (!distances.isKnown(address))
      continue;
    instruction.replaceAllUsesWith(distances.of(address));
    instruction.eraseFromParent();
    hasChanged = true;
  }
  return hasChanged ? llvm::PreservedAnalyses::none() : llvm::PreservedAnalyses::all();
}

} // namespace rtsl::codegen
