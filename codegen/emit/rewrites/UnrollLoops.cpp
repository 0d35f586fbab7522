//===- UnrollLoops.cpp - loops whose values are known when compiling ------===//
#include "codegen/emit/rewrites/UnrollLoops.h"

#include "llvm/ADT/DenseMap.h"
#include "llvm/Analysis/AssumptionCache.h"
#include "llvm/Analysis/InstructionSimplify.h"
#include "llvm/Analysis/LoopInfo.h"
#include "llvm/Analysis/OptimizationRemarkEmitter.h"
#include "llvm/Analysis/ScalarEvolution.h"
#include "llvm/Analysis/ScalarEvolutionExpressions.h"
#include "llvm/Analysis/TargetTransformInfo.h"
#include "llvm/Analysis/ValueTracking.h"
#include "llvm/IR/Dominators.h"
#include "llvm/IR/Instructions.h"
#include "llvm/IR/IntrinsicInst.h"
#include "llvm/Transforms/Utils/LoopRotationUtils.h"
#include "llvm/Transforms/Utils/LoopSimplify.h"
#include "llvm/Transforms/Utils/LoopUtils.h"
#include "llvm/Transforms/Utils/UnrollLoop.h"

#include <algorithm>
#include <vector>

namespace rtsl::codegen {

/// Longer loops, and those of more instructions when unrolled, calls counting as one, stay.
static constexpr unsigned mostTrips = 32, mostUnrolled = 4096;

namespace {

/// What a value of a loop depends on.
enum class Depends { OnNothing, OnCounter, OnMore };

class CountedLoop {
public:
  CountedLoop(llvm::Loop &loop, llvm::ScalarEvolution &evolution)
      : loop(loop), evolution(evolution) {}

  /// Whether the loop is short.
  bool isShort() {
    const unsigned trips = evolution.getSmallConstantTripCount(&loop);
    unsigned instructions = 0;
    for (const llvm::BasicBlock *block : loop.blocks())
      instructions += unsigned(block->sizeWithoutDebug());
    return trips >= 2 && trips <= mostTrips && trips * instructions <= mostUnrolled;
  }

  bool hasKnownValues() {
    for (llvm::BasicBlock *block : loop.blocks())
      for (llvm::Instruction &instruction : *block)
        if (isKnownCall(instruction) || indexesLocalArray(instruction))
          return true;
    return false;
  }

private:
  /// A call of an elementary function.
  bool isKnownCall(llvm::Instruction &instruction) {
    const auto *call = llvm::dyn_cast<llvm::CallInst>(&instruction);
    return call && !llvm::isa<llvm::IntrinsicInst>(call) && call->doesNotAccessMemory() &&
           ofOperands(*call) == Depends::OnCounter;
  }

  bool indexesLocalArray(llvm::Instruction &instruction) {
    const auto *address = llvm::dyn_cast<llvm::GetElementPtrInst>(&instruction);
    return address && llvm::isa<llvm::AllocaInst>(llvm::getUnderlyingObject(address)) &&
           ofIndices(*address) == Depends::OnCounter;
  }

  Depends of(llvm::Value *value) {
    if (llvm::isa<llvm::Constant>(value))
      return Depends::OnNothing;
    auto *instruction = llvm::dyn_cast<llvm::Instruction>(value);
    if (!instruction || !loop.contains(instruction))
      return Depends::OnMore;
    const auto [known, isNew] = ofInstruction.try_emplace(instruction, Depends::OnMore);
    if (!isNew)
      return known->second;
    const Depends result = compute(*instruction);
    return ofInstruction[instruction] = result;
  }

  Depends compute(llvm::Instruction &instruction) {
    if (llvm::isa<llvm::PHINode>(instruction))
      return isCounter(instruction) ? Depends::OnCounter : Depends::OnMore;
    return instruction.mayReadOrWriteMemory() ? Depends::OnMore : ofOperands(instruction);
  }

  bool isCounter(llvm::Instruction &instruction) {
    if (!evolution.isSCEVable(instruction.getType()))
      return false;
    const auto *steps = llvm::dyn_cast<llvm::SCEVAddRecExpr>(evolution.getSCEV(&instruction));
    return steps && steps->getLoop() == &loop && steps->isAffine() &&
           llvm::isa<llvm::SCEVConstant>(steps->getStart()) &&
           llvm::isa<llvm::SCEVConstant>(steps->getOperand(1));
  }

  Depends ofOperands(const llvm::Instruction &instruction) {
    const auto *call = llvm::dyn_cast<llvm::CallInst>(&instruction);
    return call ? ofAll(call->args()) : ofAll(instruction.operands());
  }

  Depends ofIndices(const llvm::GetElementPtrInst &address) { return ofAll(address.indices()); }

  template <typename Uses>
  Depends ofAll(Uses &&uses) {
    Depends result = Depends::OnNothing;
    for (const llvm::Use &use : uses)
      result = std::max(result, of(use.get()));
    return result;
  }

  llvm::Loop &loop;
  llvm::ScalarEvolution &evolution;
  llvm::DenseMap<llvm::Instruction *, Depends> ofInstruction;
};

/// The analyses that unrolling needs and keeps up to date.
struct Unroller {
  llvm::LoopInfo &loops;
  llvm::ScalarEvolution &evolution;
  llvm::DominatorTree &dominators;
  llvm::AssumptionCache &assumptions;
  llvm::TargetTransformInfo &target;
  llvm::OptimizationRemarkEmitter &remarks;

  Unroller(llvm::Function &function, llvm::FunctionAnalysisManager &analyses)
      : loops(analyses.getResult<llvm::LoopAnalysis>(function)),
        evolution(analyses.getResult<llvm::ScalarEvolutionAnalysis>(function)),
        dominators(analyses.getResult<llvm::DominatorTreeAnalysis>(function)),
        assumptions(analyses.getResult<llvm::AssumptionAnalysis>(function)),
        target(analyses.getResult<llvm::TargetIRAnalysis>(function)),
        remarks(analyses.getResult<llvm::OptimizationRemarkEmitterAnalysis>(function)) {}

  std::vector<llvm::Loop *> chosen() {
    std::vector<llvm::Loop *> chosen;
    for (llvm::Loop *loop : loops.getLoopsInPreorder()) {
      CountedLoop counted(*loop, evolution);
      if (loop->isInnermost() && counted.isShort() && counted.hasKnownValues())
        chosen.push_back(loop);
    }
    return chosen;
  }

  void unroll(llvm::Loop *loop) {
    llvm::simplifyLoop(loop, &dominators, &loops, &evolution, &assumptions, nullptr,
                       /*PreserveLCSSA=*/false);
    llvm::formLCSSARecursively(*loop->getOutermostLoop(), dominators, &loops, &evolution);
    const llvm::SimplifyQuery query(loop->getHeader()->getDataLayout());
    llvm::LoopRotation(loop, &loops, &target, &assumptions, &dominators, &evolution, nullptr, query,
                       /*RotationOnly=*/true, /*Threshold=*/~0u, /*IsUtilMode=*/true);
    llvm::UnrollLoopOptions options{};
    options.Count = evolution.getSmallConstantTripCount(loop);
    options.Force = true;
    if (options.Count > 1)
      llvm::UnrollLoop(loop, options, &loops, &evolution, &dominators, &assumptions, &target,
                       &remarks, /*PreserveLCSSA=*/true);
  }
};

} // namespace

llvm::PreservedAnalyses UnrollLoopsPass::run(llvm::Function &function,
                                             llvm::FunctionAnalysisManager &analyses) {
  if (analyses.getResult<llvm::LoopAnalysis>(function).empty())
    return llvm::PreservedAnalyses::all();
  Unroller unroller(function, analyses);
  const std::vector<llvm::Loop *> chosen = unroller.chosen();
  for (llvm::Loop *loop : chosen)
    unroller.unroll(loop);
  return chosen.empty() ? llvm::PreservedAnalyses::all() : llvm::PreservedAnalyses::none();
}

} // namespace rtsl::codegen
