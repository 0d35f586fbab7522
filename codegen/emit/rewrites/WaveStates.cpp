//===- WaveStates.cpp - a kernel for each state ---------------------------===//
#include "codegen/emit/rewrites/WaveStates.h"

#include "llvm/IR/IRBuilder.h"
#include "llvm/IR/InstIterator.h"
#include "llvm/IR/Module.h"
#include "llvm/Transforms/Utils/BasicBlockUtils.h"
#include "llvm/Transforms/Utils/Cloning.h"
#include "llvm/Transforms/Utils/Local.h"

#include <cassert>

namespace rtsl::codegen {

namespace {

constexpr unsigned numberOfRunState = 1; // the argument of rtsl_run_state

/// rtsl_run_state for one state, without its number: the switch is decided.
llvm::Function *runThisState(llvm::Function &runState, unsigned state) {
  llvm::ValueToValueMapTy values;
  llvm::Argument *number = runState.getArg(numberOfRunState);
  values[number] = llvm::ConstantInt::get(number->getType(), state);
  llvm::Function *copy = llvm::CloneFunction(&runState, values);
  copy->setLinkage(llvm::GlobalValue::InternalLinkage);
  for (llvm::BasicBlock &block : *copy)
    llvm::ConstantFoldTerminator(&block);
  llvm::removeUnreachableBlocks(*copy);
  return copy;
}

/// rtsl_wave_state or rtsl_block_state for one state.
llvm::Function *stateCopy(llvm::Function &any, llvm::Function &run, unsigned state) {
  llvm::ValueToValueMapTy values;
  llvm::Argument *number = any.getArg(any.arg_size() - 1);
  values[number] = llvm::ConstantInt::get(number->getType(), state);
  llvm::Function *copy = llvm::CloneFunction(&any, values);
  copy->setName(any.getName() + "_" + llvm::Twine(state));
  for (llvm::Instruction &instruction : llvm::instructions(copy))
    if (auto *call = llvm::dyn_cast<llvm::CallBase>(&instruction);
        call && call->getCalledFunction() &&
        call->getCalledFunction()->getName() == "rtsl_run_this_state")
      call->setCalledFunction(&run);
  return copy;
}

/// rtsl_wave_run_state(..., number) or rtsl_block_run_state: the copy for `number`.
void defineSwitch(llvm::Function &function, llvm::ArrayRef<llvm::Function *> copies) {
  llvm::LLVMContext &context = function.getContext();
  llvm::IRBuilder<> builder(llvm::BasicBlock::Create(context, "", &function));
  llvm::BasicBlock *end = llvm::BasicBlock::Create(context, "", &function);
  llvm::SmallVector<llvm::Value *> arguments;
  for (llvm::Argument &argument : function.args())
    arguments.push_back(&argument);
  llvm::SwitchInst *choice = builder.CreateSwitch(arguments.back(), end, unsigned(copies.size()));
  arguments.pop_back();
  for (unsigned i = 0; i < copies.size(); ++i) {
    llvm::BasicBlock *block = llvm::BasicBlock::Create(context, "", &function, end);
    choice->addCase(builder.getInt32(i + 1), block);
    builder.SetInsertPoint(block);
    builder.CreateCall(copies[i], arguments);
    builder.CreateBr(end);
  }
  builder.SetInsertPoint(end);
  builder.CreateRetVoid();
  function.setLinkage(llvm::GlobalValue::InternalLinkage);
}

} // namespace

void makeWaveStates(llvm::Module &module, unsigned count) {
  llvm::Function *any = module.getFunction("rtsl_wave_state");
  if (!any)
    any = module.getFunction("rtsl_block_state");
  llvm::Function *runState = module.getFunction("rtsl_run_state");
  assert(any && runState && "the device code of a wavefront is linked");
  llvm::SmallVector<llvm::Function *> copies;
  for (unsigned state = 1; state <= count; ++state)
    copies.push_back(stateCopy(*any, *runThisState(*runState, state), state));
  any->eraseFromParent();
  assert(module.getFunction("rtsl_run_this_state")->use_empty() && "all calls are in the copies");
  for (const char *name : {"rtsl_wave_run_state", "rtsl_block_run_state"})
    if (llvm::Function *choice = module.getFunction(name)) {
      for (llvm::Function *copy : copies)
        copy->setLinkage(llvm::GlobalValue::InternalLinkage);
      defineSwitch(*choice, copies);
    }
}

} // namespace rtsl::codegen
