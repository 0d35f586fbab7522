//===- StepCosts.cpp - what steps of the megakernel and tests cost --------===//
//
// Only the ratios matter, and only roughly: costs are powers of two. An operation on a vector
// counts once for each element, a division or root as the instructions that it becomes, and a
// function of the runtime as one of middle size. Loops count once.
//
//===----------------------------------------------------------------------===//
#include "codegen/emit/StepCosts.h"

#include "codegen/emit/LlvmModule.h"

#include "llvm/ADT/DenseMap.h"
#include "llvm/ADT/SmallPtrSet.h"
#include "llvm/Analysis/CFG.h"
#include "llvm/IR/InstIterator.h"
#include "llvm/IR/InstrTypes.h"
#include "llvm/IR/Instructions.h"
#include "llvm/IR/IntrinsicInst.h"
#include "llvm/IR/Module.h"
#include "llvm/Support/MathExtras.h"

#include <algorithm>

namespace rtsl::codegen {

namespace {

// Instructions, counted in the programs of bench/gpu (docs/gpu.md).
constexpr std::uint64_t ofDivision = 8, ofRuntimeFunction = 32, ofSample = 300, ofRay = 300,
                        ofListedInstance = 40, ofTree = 4000;
/// A factor for traversal and for new rays: the lanes of a warp diverge in these steps, so that the
/// warp takes longer than a single lane would.
constexpr std::uint64_t divergence = 4;
constexpr std::uint64_t unit = 16; // instructions of a step with the cost 1
constexpr unsigned bitsOfStep = 4, mostSteps = 64 / bitsOfStep;

class Estimate {
public:
  std::uint64_t operator()(const llvm::Function &function) {
    if (function.isDeclaration())
      return ofRuntimeFunction;
    const auto [known, isNew] = costs.try_emplace(&function, 0); // a recursion ends here
    if (!isNew)
      return known->second;
    std::uint64_t sum = 0;
    for (const llvm::BasicBlock &block : function)
      for (const llvm::Instruction &instruction : block)
        sum += costOf(instruction);
    return costs[&function] = sum;
  }

private:
  static std::uint64_t elements(const llvm::Type *type) {
    const auto *vector = llvm::dyn_cast<llvm::FixedVectorType>(type);
    return vector ? vector->getNumElements() : 1;
  }

  std::uint64_t costOf(const llvm::Instruction &instruction) {
    if (llvm::isa<llvm::PHINode, llvm::AllocaInst, llvm::GetElementPtrInst, llvm::ReturnInst,
                  llvm::DbgInfoIntrinsic, llvm::InsertElementInst, llvm::ExtractElementInst,
                  llvm::InsertValueInst, llvm::ExtractValueInst>(instruction))
      return 0;
    if (instruction.getOpcode() == llvm::Instruction::FDiv)
      return ofDivision * elements(instruction.getType());
    if (const auto *intrinsic = llvm::dyn_cast<llvm::IntrinsicInst>(&instruction))
      return (intrinsic->getIntrinsicID() == llvm::Intrinsic::sqrt ? ofDivision : 1) *
             elements(instruction.getType());
    if (const auto *call = llvm::dyn_cast<llvm::CallBase>(&instruction))
      if (const llvm::Function *callee = call->getCalledFunction())
        return (*this)(*callee);
    const bool stores = llvm::isa<llvm::StoreInst>(instruction);
    return elements(stores ? instruction.getOperand(0)->getType() : instruction.getType());
  }

  llvm::DenseMap<const llvm::Function *, std::uint64_t> costs;
};

/// The functions that rtsl_run_state calls for the states from number 1 on.
llvm::SmallVector<const llvm::Function *> statesOf(const llvm::Function &runState) {
  llvm::SmallVector<const llvm::Function *> states;
  const auto *choice = llvm::dyn_cast<llvm::SwitchInst>(runState.getEntryBlock().getTerminator());
  if (!choice)
    return states;
  for (const auto &one : choice->cases())
    for (const llvm::Instruction &instruction : *one.getCaseSuccessor())
      if (const auto *call = llvm::dyn_cast<llvm::CallInst>(&instruction)) {
        const std::size_t number = one.getCaseValue()->getZExtValue();
        states.resize(std::max(states.size(), number));
        states[number - 1] = call->getCalledFunction();
        break;
      }
  return states;
}

/// Has the function, or one that it calls, a loop? A recursion is one.
bool mayLoop(const llvm::Function &function,
             llvm::SmallPtrSetImpl<const llvm::Function *> &callers) {
  if (!callers.insert(&function).second)
    return true;
  llvm::SmallVector<std::pair<const llvm::BasicBlock *, const llvm::BasicBlock *>> backEdges;
  llvm::FindFunctionBackedges(function, backEdges);
  bool found = !backEdges.empty();
  for (const llvm::Instruction &instruction : llvm::instructions(function))
    if (const auto *call = llvm::dyn_cast<llvm::CallBase>(&instruction))
      if (const llvm::Function *callee = call->getCalledFunction();
          callee && !callee->isDeclaration())
        found = found || mayLoop(*callee, callers);
  callers.erase(&function);
  return found;
}

unsigned logarithm(std::uint64_t instructions) {
  const std::uint64_t units = std::max<std::uint64_t>(instructions / unit, 1);
  return std::min(llvm::Log2_64(units), (1u << bitsOfStep) - 1);
}

} // namespace

std::uint64_t stepCosts(const llvm::Module &module) {
  const std::uint64_t listed = knownConstant(module, "rtsl_listed_instances").value_or(0);
  const std::uint64_t ofTraversal = ofRay + (listed ? listed * ofListedInstance : ofTree);
  llvm::SmallVector<std::uint64_t> instructions = {divergence * ofTraversal, divergence * ofSample};
  Estimate estimate;
  if (const llvm::Function *runState = module.getFunction("rtsl_run_state"))
    for (const llvm::Function *state : statesOf(*runState))
      instructions.push_back(state ? estimate(*state) : 0);
  std::uint64_t costs = 0;
  for (unsigned step = 0; step < mostSteps; ++step)
    costs |=
        std::uint64_t(logarithm(instructions[std::min<std::size_t>(step, instructions.size() - 1)]))
        << (bitsOfStep * step);
  return costs;
}

std::optional<std::uint64_t> intersectCost(const llvm::Module &module) {
  const llvm::Function *intersect = module.getFunction("rtsl_rt_Primitive_intersect");
  llvm::SmallPtrSet<const llvm::Function *, 8> callers;
  if (!intersect || intersect->isDeclaration() || mayLoop(*intersect, callers))
    return std::nullopt;
  Estimate estimate;
  if (!llvm::isa<llvm::SwitchInst>(intersect->getEntryBlock().getTerminator())) // one class
    return estimate(*intersect);
  std::uint64_t most = 0;
  for (const llvm::Instruction &instruction : llvm::instructions(*intersect))
    if (const auto *call = llvm::dyn_cast<llvm::CallBase>(&instruction))
      if (const llvm::Function *callee = call->getCalledFunction())
        most = std::max(most, estimate(*callee));
  return most;
}

} // namespace rtsl::codegen
