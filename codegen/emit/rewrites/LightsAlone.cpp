//===- LightsAlone.cpp - nothing but a state's rays to lights -------------===//
#include "codegen/emit/rewrites/LightsAlone.h"

#include "llvm/ADT/SetVector.h"
#include "llvm/Analysis/AliasAnalysis.h"
#include "llvm/Analysis/LoopInfo.h"
#include "llvm/Analysis/ValueTracking.h"
#include "llvm/IR/Function.h"
#include "llvm/IR/InstIterator.h"
#include "llvm/IR/Instructions.h"
#include "llvm/IR/IntrinsicInst.h"
#include "llvm/Transforms/Scalar/ADCE.h"
#include "llvm/Transforms/Scalar/LoopDeletion.h"
#include "llvm/Transforms/Scalar/LoopPassManager.h"
#include "llvm/Transforms/Scalar/SimplifyCFG.h"
#include "llvm/Transforms/Utils/Local.h"

namespace rtsl::codegen {

namespace {

/// A store to a local variable.
bool isLocalStore(const llvm::Instruction &instruction) {
  const auto *store = llvm::dyn_cast<llvm::StoreInst>(&instruction);
  return store && store->isSimple() &&
         llvm::isa<llvm::AllocaInst>(llvm::getUnderlyingObject(store->getPointerOperand()));
}

/// Does it do more than compute a value, or set a local variable?
bool hasEffect(const llvm::Instruction &instruction) {
  if (const auto *call = llvm::dyn_cast<llvm::CallBase>(&instruction);
      call && call->onlyReadsMemory() && call->doesNotThrow())
    return false;
  return instruction.mayHaveSideEffects() && !isLocalStore(instruction) &&
         !instruction.isLifetimeStartOrEnd();
}

/// Ends the turn of the loop over slots where nothing that has an effect can follow in it.
void endTurnsEarly(llvm::Function &function, llvm::FunctionAnalysisManager &analyses) {
  for (llvm::Loop *loop : analyses.getResult<llvm::LoopAnalysis>(function)) {
    llvm::BasicBlock *latch = loop->getLoopLatch();
    if (!latch || latch == loop->getHeader() || !latch->phis().empty())
      continue;
    llvm::SmallSetVector<llvm::BasicBlock *, 32> leading; // to an effect
    for (llvm::BasicBlock *block : loop->blocks())
      if (llvm::any_of(*block, hasEffect))
        leading.insert(block);
    for (std::size_t i = 0; i < leading.size(); ++i)
      if (leading[i] != loop->getHeader())
        for (llvm::BasicBlock *before : llvm::predecessors(leading[i]))
          leading.insert(before);
    if (leading.contains(latch))
      continue;
    for (llvm::BasicBlock *block : leading)
      for (unsigned i = 0, count = block->getTerminator()->getNumSuccessors(); i < count; ++i) {
        llvm::BasicBlock *next = block->getTerminator()->getSuccessor(i);
        if (!loop->contains(next) || next == latch || leading.contains(next))
          continue;
        next->removePredecessor(block);
        block->getTerminator()->setSuccessor(i, latch);
      }
  }
  llvm::removeUnreachableBlocks(function);
}

/// Removes stores to local variables that are read, if at all, to compute what nothing depends on.
void removeLocalStores(llvm::Function &function, llvm::AAResults &aliases) {
  llvm::SmallSetVector<llvm::Instruction *, 32> stores, live;
  for (llvm::Instruction &instruction : llvm::instructions(function))
    if (isLocalStore(instruction))
      stores.insert(&instruction);
    else if (hasEffect(instruction) || instruction.isTerminator())
      live.insert(&instruction);
  for (std::size_t i = 0; i < live.size(); ++i) {
    for (llvm::Value *operand : live[i]->operands())
      if (auto *needed = llvm::dyn_cast<llvm::Instruction>(operand))
        live.insert(needed);
    if (live[i]->mayReadFromMemory())
      for (llvm::Instruction *store : stores)
        if (llvm::isRefSet(aliases.getModRefInfo(live[i], llvm::MemoryLocation::get(store))))
          live.insert(store);
  }
  for (llvm::Instruction *store : stores)
    if (!live.contains(store))
      store->eraseFromParent();
}

} // namespace

llvm::PreservedAnalyses LightsAlonePass::run(llvm::Function &function,
                                             llvm::FunctionAnalysisManager &analyses) {
  if (!function.getName().starts_with("rtsl_wave_light_"))
    return llvm::PreservedAnalyses::all();
  endTurnsEarly(function, analyses);
  analyses.invalidate(function, llvm::PreservedAnalyses::none());
  removeLocalStores(function, analyses.getResult<llvm::AAManager>(function));
  analyses.invalidate(function, llvm::PreservedAnalyses::none());

  function.addFnAttr(llvm::Attribute::MustProgress);
  for (llvm::Instruction &instruction : llvm::instructions(function))
    if (auto *call = llvm::dyn_cast<llvm::CallBase>(&instruction); call && !hasEffect(*call))
      call->addFnAttr(llvm::Attribute::WillReturn);
  llvm::FunctionPassManager passes;
  passes.addPass(llvm::ADCEPass());
  passes.addPass(llvm::createFunctionToLoopPassAdaptor(llvm::LoopDeletionPass()));
  passes.addPass(llvm::SimplifyCFGPass());
  passes.run(function, analyses);
  return llvm::PreservedAnalyses::none();
}

} // namespace rtsl::codegen
