#include "codegen/emit/rewrites/PassLaunches.h"

#include "llvm/ADT/SetVector.h"
#include "llvm/IR/AttributeMask.h"
#include "llvm/IR/IRBuilder.h"
#include "llvm/IR/Instructions.h"
#include "llvm/IR/Module.h"

namespace rtsl::codegen {

namespace {

constexpr llvm::StringLiteral launchMark = "rtsl-launch";

/// The argument that a use passes on, if it is one of a call of a function whose code is known.
llvm::Argument *passedAs(const llvm::Use &use) {
  auto *call = llvm::dyn_cast<llvm::CallBase>(use.getUser());
  if (!call || !call->isArgOperand(&use))
    return nullptr;
  llvm::Function *callee = call->getCalledFunction();
  const unsigned number = call->getArgOperandNo(&use);
  return callee && !callee->isDeclaration() && number < callee->arg_size() ? callee->getArg(number)
                                                                           : nullptr;
}

/// RtslState::launch is the first thing in a state.
bool isLoadOfLaunch(const llvm::User *user) {
  auto *load = llvm::dyn_cast<llvm::LoadInst>(user);
  return load && load->getType()->isPointerTy() && !load->isVolatile();
}

/// Are all calls of the function known?
bool isPrivate(const llvm::Function &function) {
  return function.hasLocalLinkage() &&
         !function.hasAddressTaken(nullptr, /*IgnoreCallbackUses=*/false,
                                   /*IgnoreAssumeLikeCalls=*/false);
}

/// The arguments of which only the launch is loaded.
class Launches {
public:
  explicit Launches(llvm::Module &module) {
    for (llvm::Function &function : module)
      if (!function.isDeclaration() && isPrivate(function))
        for (llvm::Argument &argument : function.args())
          if (argument.getType()->isPointerTy() && argument.hasNoAliasAttr() &&
              argument.getDereferenceableBytes() >= sizeof(void *) && !argument.use_empty())
            all.insert(&argument);
    while (removeOthers()) {
    }
  }

  llvm::SetVector<llvm::Argument *> all;

private:
  bool removeOthers() {
    return all.remove_if([&](llvm::Argument *argument) {
      return !llvm::all_of(argument->uses(), [&](const llvm::Use &use) {
        llvm::Argument *passed = passedAs(use);
        return isLoadOfLaunch(use.getUser()) || (passed && all.contains(passed));
      });
    });
  }
};

/// Loads the launch for the calls that pass a state.
void passAtCalls(llvm::Argument &argument, const llvm::SetVector<llvm::Argument *> &launches) {
  for (llvm::User *user : argument.getParent()->users()) {
    auto &call = *llvm::cast<llvm::CallBase>(user);
    llvm::Value *state = call.getArgOperand(argument.getArgNo());
    auto *ofCaller = llvm::dyn_cast<llvm::Argument>(state);
    call.removeParamAttrs(
        argument.getArgNo(),
        llvm::AttributeMask(call.getAttributes().getParamAttrs(argument.getArgNo())));
    if (ofCaller && launches.contains(ofCaller))
      continue;
    llvm::IRBuilder<> builder(&call);
    call.setArgOperand(argument.getArgNo(), builder.CreateLoad(state->getType(), state, "launch"));
  }
}

void receive(llvm::Argument &argument) {
  for (llvm::User *user : llvm::make_early_inc_range(argument.users()))
    if (isLoadOfLaunch(user)) {
      user->replaceAllUsesWith(&argument);
      llvm::cast<llvm::Instruction>(user)->eraseFromParent();
    }
  llvm::Function &function = *argument.getParent();
  function.removeParamAttrs(argument.getArgNo(), llvm::AttributeMask(argument.getAttributes()));
  function.addParamAttr(argument.getArgNo(),
                        llvm::Attribute::get(function.getContext(), launchMark));
  // What the launch refers to is now memory of an argument.
  llvm::MemoryEffects effects = function.getMemoryEffects();
  function.setMemoryEffects(
      effects |= llvm::MemoryEffects::argMemOnly(effects.getModRef(llvm::IRMemLocation::Other)));
}

} // namespace

bool isLaunch(const llvm::Argument &argument) {
  return argument.getParent()->getAttributes().hasParamAttr(argument.getArgNo(), launchMark);
}

void passLaunches(llvm::Module &module) {
  const Launches launches(module);
  for (llvm::Argument *argument : launches.all)
    passAtCalls(*argument, launches.all);
  for (llvm::Argument *argument : launches.all)
    receive(*argument);
}

} // namespace rtsl::codegen
