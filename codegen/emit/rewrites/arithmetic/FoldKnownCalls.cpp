//===- FoldKnownCalls.cpp - elementary functions of constants -------------===//
#include "codegen/emit/rewrites/arithmetic/FoldKnownCalls.h"

#include "codegen/emit/rewrites/ReplaceEach.h"
#include "codegen/ir/dialect/RtslOps.h"

#include "llvm/ADT/STLExtras.h"
#include "llvm/IR/Constants.h"

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
  return preservedBy(replaceEach(function, [](llvm::Instruction &instruction) {
    const auto *call = llvm::dyn_cast<llvm::CallInst>(&instruction);
    return call ? evaluate(*call) : nullptr;
  }));
}

} // namespace rtsl::codegen
