//===- FoldConstantFunctions.cpp - what a program states about itself -----===//
#include "codegen/emit/rewrites/FoldConstantFunctions.h"

#include "llvm/ADT/STLExtras.h"
#include "llvm/ADT/SetVector.h"
#include "llvm/IR/Instructions.h"
#include "llvm/IR/Module.h"
#include "llvm/Transforms/Scalar/InstSimplifyPass.h"
#include "llvm/Transforms/Scalar/SCCP.h"
#include "llvm/Transforms/Scalar/SimplifyCFG.h"

namespace rtsl::codegen {

/// The constant that the function returns without doing anything else; null: it does more.
static llvm::Constant *constantResult(llvm::Function &function) {
  if (function.isDeclaration() || function.isInterposable())
    return nullptr;
  auto *result = llvm::dyn_cast<llvm::ReturnInst>(&function.getEntryBlock().front());
  return result ? llvm::dyn_cast_or_null<llvm::Constant>(result->getReturnValue()) : nullptr;
}

void foldConstantFunctions(llvm::Module &module, llvm::FunctionAnalysisManager &analyses) {
  llvm::SetVector<llvm::Function *> callers;
  for (llvm::Function &function : module) {
    llvm::Constant *result = constantResult(function);
    if (!result)
      continue;
    for (llvm::User *user : llvm::make_early_inc_range(function.users())) {
      auto *call = llvm::dyn_cast<llvm::CallInst>(user);
      if (!call || call->getCalledFunction() != &function)
        continue;
      callers.insert(call->getFunction());
      call->replaceAllUsesWith(result);
      call->eraseFromParent();
    }
  }
  llvm::FunctionPassManager passes;
  passes.addPass(llvm::InstSimplifyPass());
  passes.addPass(llvm::SCCPPass());
  passes.addPass(llvm::SimplifyCFGPass());
  for (llvm::Function *caller : callers) {
    analyses.invalidate(*caller, llvm::PreservedAnalyses::none());
    analyses.invalidate(*caller, passes.run(*caller, analyses));
  }
}

} // namespace rtsl::codegen
