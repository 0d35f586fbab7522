//===- PackRecords.cpp - where the words of a sample in flight are --------===//
#include "codegen/emit/rewrites/PackRecords.h"

#include "codegen/emit/rewrites/ChosenValues.h"
#include "codegen/emit/rewrites/FoldDistances.h"

#include "llvm/ADT/STLExtras.h"
#include "llvm/IR/IRBuilder.h"
#include "llvm/IR/Instructions.h"
#include "llvm/IR/Module.h"
#include "llvm/Support/ModRef.h"
#include "llvm/Transforms/InstCombine/InstCombine.h"
#include "llvm/Transforms/Scalar/ADCE.h"
#include "llvm/Transforms/Scalar/EarlyCSE.h"
#include "llvm/Transforms/Scalar/SROA.h"
#include "llvm/Transforms/Scalar/SimplifyCFG.h"

#include <map>

namespace rtsl::codegen {

namespace {

constexpr const char *loadName = "rtsl_record_load";
constexpr const char *storeName = "rtsl_record_store";
constexpr unsigned wordsOfGroup = 4, wordBytes = 4;

// Arguments of both functions.
constexpr unsigned recordsArgument = 0, slotsArgument = 1, slotArgument = 2, numberArgument = 3,
                   wordArgument = 4;

/// The accesses to one word.
struct Word {
  llvm::SmallVector<llvm::CallInst *> loads, stores;
};

llvm::SmallVector<llvm::CallInst *> callsOf(llvm::Module &module, const char *name) {
  llvm::SmallVector<llvm::CallInst *> calls;
  if (llvm::Function *function = module.getFunction(name))
    for (llvm::User *user : function->users())
      calls.push_back(llvm::cast<llvm::CallInst>(user));
  return calls;
}

std::uint64_t numberOf(const llvm::CallInst &access) {
  return llvm::cast<llvm::ConstantInt>(access.getArgOperand(numberArgument))->getZExtValue();
}

std::map<std::uint64_t, Word> wordsOf(llvm::Module &module) {
  std::map<std::uint64_t, Word> words;
  for (llvm::CallInst *load : callsOf(module, loadName))
    words[numberOf(*load)].loads.push_back(load);
  for (llvm::CallInst *store : callsOf(module, storeName))
    words[numberOf(*store)].stores.push_back(store);
  return words;
}

/// Whether the store writes what was loaded from the same place. A step loads and stores each word
/// once, so it has not changed in between.
bool storesWhatWasThere(const llvm::CallInst &store) {
  const auto *load = llvm::dyn_cast<llvm::CallInst>(store.getArgOperand(wordArgument));
  return load && load->getCalledFunction() && load->getCalledFunction()->getName() == loadName &&
         llvm::all_of(llvm::seq(numberArgument + 1), [&](unsigned argument) {
           return load->getArgOperand(argument) == store.getArgOperand(argument);
         });
}

/// The constant that all stores of the word write, except those of what was there and of undefined
/// values; null: there is none.
llvm::Constant *onlyValue(const Word &word) {
  llvm::SmallVector<llvm::Value *> stored;
  for (const llvm::CallInst *store : word.stores)
    stored.push_back(store->getArgOperand(wordArgument));
  llvm::Constant *only = nullptr;
  const bool isOne = visitChosenValues(std::move(stored), [&](llvm::Value *value) {
    if (llvm::is_contained(word.loads, value))
      return true;
    auto *constant = llvm::dyn_cast<llvm::ConstantInt>(value);
    if (!constant || (only && only != constant))
      return false;
    only = constant;
    return true;
  });
  return isOne ? only : nullptr;
}

/// Removes accesses without which no step computes anything else. Returns whether there were any.
bool removeUseless(llvm::Module &module) {
  bool hasChanged = false;
  const auto eraseStores = [&](Word &word, llvm::function_ref<bool(const llvm::CallInst &)> is) {
    llvm::erase_if(word.stores, [&](llvm::CallInst *store) {
      if (!is(*store))
        return false;
      hasChanged = true;
      store->eraseFromParent();
      return true;
    });
  };
  for (auto &numbered : wordsOf(module)) {
    Word &word = numbered.second;
    eraseStores(word, [&](const llvm::CallInst &store) {
      return word.loads.empty() || storesWhatWasThere(store) ||
             llvm::isa<llvm::UndefValue>(store.getArgOperand(wordArgument));
    });
    llvm::Constant *value = word.stores.empty() ? nullptr : onlyValue(word);
    if (word.stores.empty() && !word.loads.empty()) // no step writes it: any value will do
      value = llvm::Constant::getNullValue(word.loads.front()->getType());
    if (!value)
      continue;
    for (llvm::CallInst *load : word.loads) {
      load->replaceAllUsesWith(value);
      load->eraseFromParent();
      hasChanged = true;
    }
    word.loads.clear();
    eraseStores(word, [](const llvm::CallInst &) { return true; });
  }
  return hasChanged;
}

llvm::FunctionPassManager simplification() {
  llvm::FunctionPassManager passes;
  passes.addPass(FoldDistancesPass());
  passes.addPass(llvm::InstCombinePass());
  passes.addPass(llvm::SROAPass(llvm::SROAOptions::ModifyCFG));
  passes.addPass(llvm::EarlyCSEPass(/*UseMemorySSA=*/true));
  passes.addPass(llvm::InstCombinePass());
  passes.addPass(llvm::SimplifyCFGPass());
  passes.addPass(llvm::ADCEPass());
  return passes;
}

/// Address spaces of a GPU.
constexpr unsigned anyMemory = 0, globalMemory = 1, sharedMemory = 3;

/// The memory that the records of a program are in.
unsigned memoryOfRecords(const llvm::Module &module) {
  if (!module.getTargetTriple().isNVPTX())
    return anyMemory;
  return module.getFunction("rtsl_persistent") ? sharedMemory : globalMemory;
}

/// The address of word `place` of the record that an access is for.
llvm::Value *addressOf(llvm::IRBuilder<> &builder, const llvm::CallInst &access, unsigned place,
                       unsigned memory) {
  llvm::Value *records = access.getArgOperand(recordsArgument);
  if (memory != anyMemory)
    records = builder.CreateAddrSpaceCast(records, builder.getPtrTy(memory));
  const auto wide = [&](unsigned argument) {
    return builder.CreateZExt(access.getArgOperand(argument), builder.getInt64Ty());
  };
  llvm::Value *group = builder.CreateAdd(
      builder.CreateMul(builder.getInt64(place / wordsOfGroup), wide(slotsArgument)),
      wide(slotArgument));
  llvm::Value *begin =
      builder.CreateGEP(llvm::ArrayType::get(builder.getInt32Ty(), wordsOfGroup), records, group);
  return builder.CreateConstGEP1_64(builder.getInt32Ty(), begin, place % wordsOfGroup);
}

void lowerAccess(llvm::CallInst &access, unsigned place, unsigned memory) {
  llvm::IRBuilder<> builder(&access);
  const llvm::Align alignment(place % wordsOfGroup == 0 ? wordsOfGroup * wordBytes : wordBytes);
  llvm::Value *address = addressOf(builder, access, place, memory);
  if (access.getCalledFunction()->getName() == loadName)
    access.replaceAllUsesWith(builder.CreateAlignedLoad(builder.getInt32Ty(), address, alignment));
  else
    builder.CreateAlignedStore(access.getArgOperand(wordArgument), address, alignment);
  access.eraseFromParent();
}

void defineGroups(llvm::Module &module, unsigned groups) {
  llvm::Function *function = module.getFunction("rtsl_record_groups");
  if (!function)
    return;
  llvm::IRBuilder<> builder(llvm::BasicBlock::Create(module.getContext(), "", function));
  builder.CreateRet(builder.getInt32(groups));
}

} // namespace

void declareRecords(llvm::Module &module) {
  for (const char *name : {loadName, storeName})
    if (llvm::Function *function = module.getFunction(name)) {
      function->setMemoryEffects(llvm::MemoryEffects::inaccessibleMemOnly(
          name == loadName ? llvm::ModRefInfo::Ref : llvm::ModRefInfo::Mod));
      function->setDoesNotThrow();
      function->setWillReturn();
    }
}

llvm::PreservedAnalyses PackRecordsPass::run(llvm::Module &module,
                                             llvm::ModuleAnalysisManager &analyses) {
  auto &functions =
      analyses.getResult<llvm::FunctionAnalysisManagerModuleProxy>(module).getManager();
  llvm::FunctionPassManager simplify = simplification();
  do {
    for (llvm::Function &function : module)
      if (!function.isDeclaration()) {
        functions.invalidate(function, llvm::PreservedAnalyses::none());
        functions.invalidate(function, simplify.run(function, functions));
      }
  } while (removeUseless(module));
  const unsigned memory = memoryOfRecords(module);
  unsigned place = 0;
  for (const auto &numbered : wordsOf(module)) {
    for (llvm::CallInst *load : numbered.second.loads)
      lowerAccess(*load, place, memory);
    for (llvm::CallInst *store : numbered.second.stores)
      lowerAccess(*store, place, memory);
    ++place;
  }
  defineGroups(module, (place + wordsOfGroup - 1) / wordsOfGroup);
  return llvm::PreservedAnalyses::none();
}

} // namespace rtsl::codegen
