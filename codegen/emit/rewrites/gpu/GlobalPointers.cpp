//===- GlobalPointers.cpp - where pointers of a scene lead on a GPU -------===//
#include "codegen/emit/rewrites/gpu/GlobalPointers.h"

#include "codegen/emit/rewrites/PassLaunches.h"

#include "llvm/Analysis/ValueTracking.h"
#include "llvm/IR/IRBuilder.h"
#include "llvm/IR/InstIterator.h"
#include "llvm/IR/PatternMatch.h"
#include "llvm/Support/NVPTXAddrSpace.h"

namespace rtsl::codegen {

namespace {

constexpr unsigned global = llvm::NVPTXAS::ADDRESS_SPACE_GLOBAL;

/// The pointers of a function that lead to memory of the scene.
class OfScene {
public:
  /// Is it loaded from there? The address of a buffer is loaded as two words.
  bool isFound(const llvm::Instruction &instruction) {
    if (!instruction.getType()->isPointerTy() ||
        instruction.getType()->getPointerAddressSpace() != llvm::NVPTXAS::ADDRESS_SPACE_GENERIC)
      return false;
    if (const auto *address = llvm::dyn_cast<llvm::IntToPtrInst>(&instruction))
      return isAddress(*address->getOperand(0));
    return isLoaded(instruction);
  }

private:
  bool isLoaded(const llvm::Value &value) {
    const auto *load = llvm::dyn_cast<llvm::LoadInst>(&value);
    return load && isThere(*load->getPointerOperand());
  }

  bool isAddress(const llvm::Value &value) {
    using namespace llvm::PatternMatch;
    llvm::Value *low = nullptr, *high = nullptr;
    if (match(&value,
              m_c_Or(m_Shl(m_ZExt(m_Value(high)), m_SpecificInt(32)), m_ZExt(m_Value(low)))))
      return isLoaded(*low) && isLoaded(*high);
    return isLoaded(value);
  }

  /// Does the address lead to the launch or to memory of the scene?
  bool isThere(const llvm::Value &address) {
    llvm::SmallVector<const llvm::Value *> objects;
    llvm::getUnderlyingObjects(&address, objects, nullptr, /*MaxLookup=*/0);
    return llvm::all_of(objects, [&](const llvm::Value *object) { return isObject(*object); });
  }

  bool isObject(const llvm::Value &object) {
    if (object.getName() == "rtsl_launch" && llvm::isa<llvm::GlobalVariable>(object))
      return true;
    if (const auto *argument = llvm::dyn_cast<llvm::Argument>(&object))
      return isLaunch(*argument);
    const auto *instruction = llvm::dyn_cast<llvm::Instruction>(&object);
    if (!instruction)
      return false;
    // One that is loaded from memory to which it has led itself, in a loop, is taken for none.
    const auto [known, isNew] = found.try_emplace(instruction, false);
    if (!isNew)
      return known->second;
    return found[instruction] = isFound(*instruction);
  }

  llvm::DenseMap<const llvm::Instruction *, bool> found;
};

} // namespace

llvm::PreservedAnalyses GlobalPointersPass::run(llvm::Function &function,
                                                llvm::FunctionAnalysisManager &) {
  OfScene ofScene;
  llvm::SmallVector<llvm::Instruction *> pointers;
  for (llvm::Instruction &instruction : llvm::instructions(function))
    if (ofScene.isFound(instruction))
      pointers.push_back(&instruction);
  for (llvm::Instruction *pointer : pointers) {
    llvm::IRBuilder<> builder(pointer->getNextNode());
    llvm::Value *there =
        builder.CreateAddrSpaceCast(pointer, llvm::PointerType::get(function.getContext(), global));
    llvm::Value *known = builder.CreateAddrSpaceCast(there, pointer->getType());
    pointer->replaceUsesWithIf(known, [&](llvm::Use &use) { return use.getUser() != there; });
  }
  return pointers.empty() ? llvm::PreservedAnalyses::all() : llvm::PreservedAnalyses::none();
}

} // namespace rtsl::codegen
