//===- WaveStates.cpp - a kernel for each state ---------------------------===//
#include "codegen/emit/rewrites/WaveStates.h"

#include "llvm/ADT/SetVector.h"
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
/// A kernel that looks for lights waits for the nodes of trees most of the time, and more warps
/// gain more than more registers do (docs/gpu.md).
constexpr const char *registersForLights = "64";

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

/// Does a state call `illuminate`, and has it so many instructions, with all functions of the
/// program that it calls?
bool needsLights(llvm::Function &state, unsigned leastInstructions) {
  bool asks = false;
  unsigned instructions = 0;
  llvm::SmallSetVector<llvm::Function *, 32> reached;
  reached.insert(&state);
  for (std::size_t i = 0; i < reached.size(); ++i) {
    instructions += reached[i]->getInstructionCount();
    for (llvm::Instruction &instruction : llvm::instructions(*reached[i])) {
      auto *call = llvm::dyn_cast<llvm::CallBase>(&instruction);
      llvm::Function *callee = call ? call->getCalledFunction() : nullptr;
      if (!callee)
        continue;
      const llvm::StringRef name = callee->getName();
      asks |= name == "rtsl_illuminance" || name == "rtsl_illuminate_by_surface";
      const bool isOfRuntime = name.starts_with("rtsl_") || name.starts_with("_ZN4rtsl");
      if (!isOfRuntime)
        reached.insert(callee);
    }
  }
  return asks && instructions >= leastInstructions;
}

/// rtsl_wave_state, rtsl_wave_light or rtsl_block_state for one state.
llvm::Function *stateCopy(llvm::Function &any, llvm::Function &run, unsigned state,
                          bool knowsLights) {
  llvm::ValueToValueMapTy values;
  llvm::Argument *number = any.getArg(any.arg_size() - 1);
  values[number] = llvm::ConstantInt::get(number->getType(), state);
  llvm::Function *copy = llvm::CloneFunction(&any, values);
  copy->setName(any.getName() + "_" + llvm::Twine(state));
  for (llvm::Instruction &instruction : llvm::make_early_inc_range(llvm::instructions(copy))) {
    auto *call = llvm::dyn_cast<llvm::CallBase>(&instruction);
    const llvm::StringRef callee =
        call && call->getCalledFunction() ? call->getCalledFunction()->getName() : "";
    if (callee == "rtsl_run_this_state") {
      call->setCalledFunction(&run);
    } else if (callee == "rtsl_are_lights_known") {
      call->replaceAllUsesWith(llvm::ConstantInt::get(call->getType(), knowsLights));
      call->eraseFromParent();
    }
  }
  return copy;
}

/// The copy for each state from 1 on; null: there is none.
using Copies = llvm::SmallVector<llvm::Function *>;

/// rtsl_wave_run_state(..., number) and the like: runs the copy for `number`, if there is one.
void defineSwitch(llvm::Function &function, const Copies &copies) {
  llvm::LLVMContext &context = function.getContext();
  llvm::IRBuilder<> builder(llvm::BasicBlock::Create(context, "", &function));
  llvm::BasicBlock *end = llvm::BasicBlock::Create(context, "", &function);
  llvm::SmallVector<llvm::Value *> arguments;
  for (llvm::Argument &argument : function.args())
    arguments.push_back(&argument);
  llvm::SwitchInst *choice = builder.CreateSwitch(arguments.back(), end, unsigned(copies.size()));
  arguments.pop_back();
  for (unsigned i = 0; i < copies.size(); ++i) {
    if (!copies[i])
      continue;
    copies[i]->setLinkage(llvm::GlobalValue::InternalLinkage);
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

void makeWaveStates(llvm::Module &module, unsigned count, unsigned litFrom) {
  llvm::Function *any = module.getFunction("rtsl_wave_state");
  if (!any)
    any = module.getFunction("rtsl_block_state");
  llvm::Function *anyLight = module.getFunction("rtsl_wave_light");
  llvm::Function *runState = module.getFunction("rtsl_run_state");
  assert(any && runState && "the device code of a wavefront is linked");
  Copies states, lights;
  for (unsigned state = 1; state <= count; ++state) {
    llvm::Function *run = runThisState(*runState, state);
    const bool isLit = anyLight && needsLights(*run, litFrom);
    states.push_back(stateCopy(*any, *run, state, isLit));
    lights.push_back(isLit ? stateCopy(*anyLight, *run, state, isLit) : nullptr);
    if (isLit)
      lights.back()->addFnAttr("nvvm.maxnreg", registersForLights);
  }
  any->eraseFromParent();
  if (anyLight)
    anyLight->eraseFromParent();
  assert(module.getFunction("rtsl_run_this_state")->use_empty() && "all calls are in the copies");
  for (const char *name : {"rtsl_wave_run_state", "rtsl_block_run_state"})
    if (llvm::Function *choice = module.getFunction(name))
      defineSwitch(*choice, states);
  if (llvm::Function *choice = module.getFunction("rtsl_wave_run_light"))
    defineSwitch(*choice, lights);
}

} // namespace rtsl::codegen
