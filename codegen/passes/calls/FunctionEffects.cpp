#include "codegen/passes/calls/FunctionEffects.h"

#include "codegen/ir/Attributes.h"
#include "codegen/ir/BaseAddress.h"
#include "codegen/ir/Lookups.h"
#include "codegen/ir/MemoryAccesses.h"
#include "codegen/ir/Rays.h"

#include "mlir/Interfaces/SideEffectInterfaces.h"

#include <algorithm>

namespace rtsl::codegen {

namespace {

using mlir::func::CallOp;
using mlir::func::FuncOp;
using Kind = ir::MemoryLocation::Kind;

/// Functions that call each other in a chain, twice each, have more than can be counted.
constexpr unsigned mostOperations = 1 << 20;

FunctionEffects unknownEffects() {
  FunctionEffects effects;
  effects.isPure = false;
  effects.sendsRays = effects.traces = effects.writesAny = true;
  return effects;
}

/// Collects the effects of one function.
class Collector {
public:
  Collector(EffectsOfFunctions &all, FuncOp function)
      : all(all), isInLookup(ir::attr::inLookup.isOn(function)) {
    function.walk([&](mlir::Operation *op) { add(op); });
  }

  FunctionEffects effects;

private:
  void add(mlir::Operation *op) {
    ++effects.operations;
    if (auto call = llvm::dyn_cast<CallOp>(op)) {
      addCallee(all.of(call));
      for (const mlir::Value operand : call.getOperands())
        if (llvm::isa<ir::PtrType>(operand.getType())) {
          addRead(operand);
          addWrite(ir::locationOf(operand));
        }
      return;
    }
    if (ir::sendsRays(op)) {
      effects.isPure = false;
      effects.sendsRays = true;
      effects.traces |= ir::isTrace(op);
      for (const char *name : {"LightDirection", "LightDistance", "LightColor", "PDF"})
        effects.writes.insert(name); // by a light
      return;
    }
    if (llvm::isa<FuncOp, ir::VarOp, ir::BufferElementOp, ir::BufferLengthOp>(op) ||
        mlir::isMemoryEffectFree(op) || op->hasTrait<mlir::OpTrait::IsTerminator>())
      return;
    if (!llvm::isa<ir::LoadOp, ir::StoreOp, ir::CopyOp, ir::ClearOp>(op)) {
      effects.isPure = false;
      effects.writesAny |= !llvm::isa<ir::RandOp>(op);
      return;
    }
    auto load = llvm::dyn_cast<ir::LoadOp>(op);
    auto copy = llvm::dyn_cast<ir::CopyOp>(op);
    effects.isPure &= !(load && ir::isInOutputBuffer(load.getAddress())) &&
                      !(copy && ir::isInOutputBuffer(copy.getSource()));
    if (load)
      addRead(load.getAddress());
    if (copy)
      addRead(copy.getSource());
    for (const ir::MemoryLocation &location : ir::accessesOf(op).writes)
      addWrite(location);
  }

  void addCallee(const FunctionEffects &callee) {
    effects.isPure &= callee.isPure;
    effects.sendsRays |= callee.sendsRays;
    effects.traces |= callee.traces;
    effects.operations = std::min(effects.operations + callee.operations, mostOperations);
    effects.writesAny |= callee.writesAny;
    for (const auto &entry : callee.reads)
      addState(effects.reads, entry.getKey());
    for (const auto &entry : callee.writes)
      addState(effects.writes, entry.getKey());
  }

  /// An argument counts where the function is called.
  void addRead(mlir::Value address) {
    const ir::MemoryLocation location = ir::locationOf(address);
    if (location.kind == Kind::State)
      addState(effects.reads, location.name);
    effects.isPure &= location.kind == Kind::State || location.kind == Kind::Scene ||
                      location.kind == Kind::Attribute || location.kind == Kind::Variable ||
                      llvm::isa<mlir::BlockArgument>(ir::baseAddress(address));
  }

  /// The same.
  void addWrite(const ir::MemoryLocation &location) {
    if (location.kind == Kind::State)
      addState(effects.writes, location.name);
    effects.writesAny |= location.kind == Kind::Scene;
    effects.writesArguments |= location.kind == Kind::Unknown;
    effects.isPure &= location.kind == Kind::Variable || location.kind == Kind::Unknown ||
                      (location.kind == Kind::State && ir::isLookupResult(location.name));
  }

  /// What it stores around calls of textures, for itself, is no effect.
  void addState(llvm::StringSet<> &names, llvm::StringRef name) const {
    if (isInLookup || !ir::isLookupResult(name))
      names.insert(name);
  }

  EffectsOfFunctions &all;
  bool isInLookup;
};

} // namespace

EffectsOfFunctions::EffectsOfFunctions(mlir::ModuleOp module) : symbols(module) {
  llvm::SmallVector<FuncOp> pending;
  const auto add = [&](FuncOp function) {
    if (receiveState.insert(function).second)
      pending.push_back(function);
  };
  // What a call passes on of its caller's arguments.
  llvm::DenseMap<mlir::Operation *, llvm::SmallVector<FuncOp>> passedOn;
  module.walk([&](CallOp call) {
    for (const mlir::Value operand : call.getOperands()) {
      if (!llvm::isa<ir::PtrType>(operand.getType()))
        continue;
      if (llvm::isa<mlir::BlockArgument>(ir::baseAddress(operand)))
        passedOn[call->getParentOfType<FuncOp>()].push_back(calleeOf(call));
      else if (ir::locationOf(operand).kind != Kind::Variable)
        add(calleeOf(call));
    }
  });
  for (auto function : module.getOps<FuncOp>())
    if (!function.isPrivate())
      add(function);
  while (!pending.empty())
    for (FuncOp callee : passedOn.lookup(pending.pop_back_val()))
      add(callee);
}

const FunctionEffects &EffectsOfFunctions::of(FuncOp function) {
  const auto [entry, isNew] = known.try_emplace(function.getOperation(), unknownEffects());
  if (!isNew || function.isExternal()) // complete, or that of a function that calls itself
    return entry->second;
  return known[function] = Collector(*this, function).effects;
}

} // namespace rtsl::codegen
