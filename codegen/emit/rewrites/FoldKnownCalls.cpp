//===- FoldKnownCalls.cpp - elementary functions of constants -------------===//
#include "codegen/emit/rewrites/FoldKnownCalls.h"

#include "codegen/ir/dialect/RtslOps.h"

#include "llvm/ADT/STLExtras.h"
#include "llvm/IR/Constants.h"
#include "llvm/IR/InstIterator.h"
#include "llvm/IR/Instructions.h"

#include <optional>

namespace rtsl::codegen {

/// The result of the call; null: it is not known.
static llvm::Constant *evaluate(const llvm::CallInst &call) {
  const llvm::Function *callee = call.getCalledFunction();
  llvm::StringRef name = callee ? callee->getName() : llvm::StringRef();
  if (!name.consume_front("rtsl_") || !call.getType()->isFloatTy())
    return nullptr;
  name.consume_front("fast_"); // its result is within the error of the approximation
  const std::optional<ir::Elementary> function = ir::symbolizeElementary(name);
  if (!function)
    return nullptr;
  llvm::SmallVector<float> arguments;
  for (const llvm::Value *argument : call.args())
    if (const auto *constant = llvm::dyn_cast<llvm::ConstantFP>(argument))
      arguments.push_back(constant->getValueAPF().convertToFloat());
    else
      return nullptr;
  return llvm::ConstantFP::get(call.getContext(),
                               llvm::APFloat(ir::evaluate(*function, arguments)));
}

llvm::PreservedAnalyses FoldKnownCallsPass::run(llvm::Function &function,
                                                llvm::FunctionAnalysisManager &) {
  bool hasChanged = false;
  for (llvm::Instruction &instruction : llvm::make_early_inc_range(llvm::instructions(function))) {
    auto *call = llvm::dyn_cast<llvm::CallInst>(&instruction);
    llvm::Constant *result = call ? evaluate(*call) : nullptr;
    if (!result)
      continue;
    call->replaceAllUsesWith(result);
    call->eraseFromParent();
    hasChanged = true;
  }
  if (!hasChanged)
    return llvm::PreservedAnalyses::all();
  llvm::PreservedAnalyses preserved;
  preserved.preserveSet<llvm::CFGAnalyses>();
  return preserved;
}

} // namespace rtsl::codegen
