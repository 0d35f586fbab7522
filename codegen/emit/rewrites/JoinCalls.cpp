//===- JoinCalls.cpp - a program as one function --------------------------===//
#include "codegen/emit/rewrites/JoinCalls.h"

#include "codegen/emit/rewrites/PassLaunches.h"

#include "llvm/ADT/DenseMap.h"
#include "llvm/ADT/STLExtras.h"
#include "llvm/IR/InstIterator.h"
#include "llvm/IR/InstrTypes.h"
#include "llvm/IR/IntrinsicInst.h"
#include "llvm/IR/Module.h"

#include <algorithm>
#include <cstdint>

namespace rtsl::codegen {

namespace {

/// Instructions before optimisation. The examples have 5,000 to 40,000.
constexpr std::uint64_t mostInstructions = 150'000;

bool takesAddress(const llvm::Function &function) {
  return llvm::any_of(function.args(), [](const llvm::Argument &argument) {
    return argument.getType()->isPointerTy() && !argument.hasByValAttr() &&
           !argument.hasStructRetAttr() && !isLaunch(argument);
  });
}

/// Functions of the device code that rarely run are left out of line; those of a program that are,
/// because there are many of them.
bool mayBeJoined(const llvm::Function &function) {
  return !function.hasFnAttribute(llvm::Attribute::NoInline) ||
         function.hasFnAttribute(llvm::Attribute::Cold);
}

class Sizes {
public:
  /// Instructions of a function with all callees that are inlined, or more than mostInstructions.
  std::uint64_t of(const llvm::Function &function) {
    // for a recursive function
    const auto [known, isNew] = sizes.try_emplace(&function, tooMany);
    if (!isNew)
      return known->second;
    std::uint64_t size = 0;
    for (const llvm::Instruction &instruction : llvm::instructions(function)) {
      ++size;
      const auto *call = llvm::dyn_cast<llvm::CallBase>(&instruction);
      const llvm::Function *callee = call ? call->getCalledFunction() : nullptr;
      if (callee && !callee->isDeclaration() && takesAddress(*callee))
        size = std::min(size + of(*callee), tooMany);
    }
    return sizes[&function] = size;
  }

private:
  static constexpr std::uint64_t tooMany = mostInstructions + 1;
  llvm::DenseMap<const llvm::Function *, std::uint64_t> sizes;
};

} // namespace

bool joinCalls(llvm::Module &module) {
  // The kernels of a wavefront are small without shading code that reads nothing of the ray; in a
  // megakernel, which has few registers, it is better inlined.
  if (module.getFunction("rtsl_record_store"))
    passLaunches(module);
  llvm::SmallVector<llvm::Function *> joined;
  Sizes sizes;
  for (llvm::Function &function : module) {
    if (function.isDeclaration()) {
      // Code outside of the module takes the address, so the variable stays in memory anyway. The
      // records of a wavefront (PackRecords.h) are no variables.
      if (!function.isIntrinsic() && takesAddress(function) && !function.use_empty() &&
          !function.onlyAccessesInaccessibleMemory())
        return false;
      continue;
    }
    if (!function.hasLocalLinkage() && sizes.of(function) > mostInstructions)
      return false;
    if (!takesAddress(function) || function.use_empty())
      continue;
    if (!mayBeJoined(function))
      return false;
    joined.push_back(&function);
  }
  for (llvm::Function *function : joined) {
    function->removeFnAttr(llvm::Attribute::NoInline);
    function->addFnAttr(llvm::Attribute::AlwaysInline);
  }
  return !joined.empty();
}

} // namespace rtsl::codegen
