//===- Recompute.cpp - operations that can be repeated after a trace ------===//
#include "codegen/passes/continuation/common/Recompute.h"

#include "codegen/ir/Attributes.h"
#include "codegen/ir/BaseAddress.h"
#include "codegen/ir/MemoryAccesses.h"
#include "codegen/ir/Slots.h"

#include "mlir/Interfaces/SideEffectInterfaces.h"
#include "llvm/ADT/SmallPtrSet.h"
#include "llvm/ADT/StringSwitch.h"

namespace rtsl::continuation {

/// Who writes a state variable (StateVariables.def).
enum class Writer : std::uint8_t { Shader, Sample, Ray };

/// State that only the runtime writes, before a shader runs: calls do not change it.
static bool isFixed(llvm::StringRef variable) {
  return llvm::StringSwitch<bool>(variable)
#define RTSL_STATE_VARIABLE(name, type, writer, need, ...)                                         \
  .Case(#name, Writer::writer != Writer::Shader)
#include "language/StateVariables.def"
      .Default(false);
}

bool StateWrites::add(const StateWrites &other) {
  bool isNew = other.any && !any;
  any |= other.any;
  for (const auto &entry : other.names)
    isNew |= names.insert(entry.getKey()).second;
  return isNew;
}

/// The key for the payload, which no state variable has as its name.
static constexpr llvm::StringLiteral payloadName = "payload";

static StateWrites writesThrough(mlir::Value address) {
  using Kind = ir::MemoryLocation::Kind;
  StateWrites writes;
  const ir::MemoryLocation location = ir::locationOf(address);
  if (location.kind == Kind::State)
    writes.names.insert(location.name);
  else if (location.kind == Kind::Payload)
    writes.names.insert(payloadName);
  else if (location.kind == Kind::Argument || location.kind == Kind::Unknown)
    writes.any = true; // any address of the caller
  return writes;
}

static bool isLight(FuncOp function) {
  auto method = ir::attr::methodName.of(function);
  return (method && method.getValue() == "illumination") ||
         ir::slotOf(function) == ir::slot::illumination;
}

WriteSummary::WriteSummary(mlir::ModuleOp module) {
  for (llvm::StringRef name : {"LightDirection", "LightDistance", "LightColor"})
    illumination.names.insert(name);
  bool hasLights = false;
  for (FuncOp function : module.getOps<FuncOp>()) {
    StateWrites &writes = functions[function.getSymNameAttr()];
    if (!function.isExternal()) {
      hasLights |= isLight(function);
      continue;
    }
    const auto known = ir::attr::writes.of(function); // OpenCalls.cpp
    writes.any = !known;
    if (known)
      for (auto name : known.getAsRange<mlir::StringAttr>())
        writes.names.insert(name.getValue());
  }
  propagate(module);
  if (!hasLights) // not linked yet: the lights are not known
    illumination.any = true;
}

/// Adds the writes of functions to those of their callers. Recursion through references ends when
/// nothing changes.
void WriteSummary::propagate(mlir::ModuleOp module) {
  // A point that is lit counts as a call of the lights: under this name, which no function has.
  const auto lights = mlir::StringAttr::get(module.getContext(), "");
  llvm::DenseMap<mlir::StringAttr, llvm::SmallVector<mlir::StringAttr, 2>> callers;
  llvm::SmallVector<mlir::StringAttr> changed;
  for (FuncOp function : module.getOps<FuncOp>()) {
    const mlir::StringAttr name = function.getSymNameAttr();
    changed.push_back(name);
    if (function.isExternal())
      continue;
    if (isLight(function))
      callers[name].push_back(lights);
    StateWrites &writes = functions[name];
    function.walk([&](mlir::Operation *op) {
      if (auto light = llvm::dyn_cast<ir::IlluminateOp>(op); light && light.getIndex())
        callers[lights].push_back(name);
      if (auto call = llvm::dyn_cast<mlir::func::CallOp>(op);
          call && functions.contains(call.getCalleeAttr().getAttr()))
        callers[call.getCalleeAttr().getAttr()].push_back(name);
      else
        writes.add(of(op));
    });
  }
  while (!changed.empty()) {
    const mlir::StringAttr name = changed.pop_back_val();
    const StateWrites &writes = name == lights ? illumination : functions[name];
    for (mlir::StringAttr caller : callers.lookup(name))
      if ((caller == lights ? illumination : functions[caller]).add(writes))
        changed.push_back(caller);
  }
}

StateWrites WriteSummary::of(mlir::Operation *op) const {
  StateWrites writes;
  if (auto store = llvm::dyn_cast<ir::StoreOp>(op))
    return writesThrough(store.getAddress());
  if (auto copy = llvm::dyn_cast<ir::CopyOp>(op))
    return writesThrough(copy.getTarget());
  if (auto clear = llvm::dyn_cast<ir::ClearOp>(op))
    return writesThrough(clear.getAddress());
  if (auto call = llvm::dyn_cast<mlir::func::CallOp>(op)) {
    // If the callee writes through its address parameters, it writes the caller's state only if
    // passed such an address.
    auto callee = functions.find(call.getCalleeAttr().getAttr());
    if (callee == functions.end()) {
      writes.any = true;
      return writes;
    }
    writes.add(callee->second);
    return writes;
  }
  if (auto light = llvm::dyn_cast<ir::IlluminateOp>(op)) {
    if (light.getIndex())
      return illumination;
    for (const char *name : {"LightDirection", "LightDistance", "LightColor", "PDF"})
      writes.names.insert(name);
    return writes;
  }
  auto addNamed = [&](std::optional<mlir::ArrayAttr> names) {
    writes.any = !names;
    if (names)
      for (auto name : names->getAsRange<mlir::StringAttr>())
        writes.names.insert(name.getValue());
    return writes;
  };
  if (auto call = llvm::dyn_cast<ir::EvaluateOp>(op))
    return addNamed(call.getWrites());
  if (auto call = llvm::dyn_cast<ir::EnterOp>(op))
    return addNamed(call.getWrites());
  if (llvm::isa<ir::CallMethodOp, ir::HitOp>(op))
    writes.any = true;
  return writes;
}

/// Searches backwards from the suspend for the load; nothing on a path may write the loaded
/// address.
bool Recompute::isUnchanged(ir::LoadOp load, llvm::StringRef state, ir::SuspendOp suspend) {
  auto [known, isNew] = unchanged.try_emplace({load, suspend}, false);
  if (!isNew)
    return known->second;
  const bool fixed = isFixed(state);
  auto writes = [&](mlir::Operation *op) {
    if (llvm::isa<ir::IlluminateOp>(op) && state == "HitPoint")
      return false; // written by lights, but restored (runtime/device/engines/Classic.h)
    StateWrites found = summary.of(op);
    return found.names.contains(state) || (found.any && !fixed);
  };
  if (auto [anywhere, isFirst] = written.try_emplace(state, false); isFirst)
    anywhere->second =
        function
            .walk([&](mlir::Operation *op) {
              return writes(op) ? mlir::WalkResult::interrupt() : mlir::WalkResult::advance();
            })
            .wasInterrupted();
  if (!written.lookup(state))
    return unchanged[{load, suspend}] = true;
  llvm::SmallPtrSet<mlir::Block *, 16> seen;
  llvm::SmallVector<mlir::Operation *> ends = {suspend};
  while (!ends.empty()) {
    mlir::Operation *op = ends.pop_back_val();
    mlir::Block *block = op->getBlock();
    while (op && op != load) {
      if (writes(op))
        return false;
      op = op->getPrevNode();
    }
    if (op == load)
      continue;
    for (mlir::Block *predecessor : block->getPredecessors())
      if (seen.insert(predecessor).second)
        ends.push_back(predecessor->getTerminator());
  }
  unchanged[{load, suspend}] = true;
  return true;
}

bool Recompute::isPossible(mlir::Operation *op, ir::SuspendOp suspend) {
  if (free.lookup(op))
    return true;
  if (op->getNumRegions() != 0 || op->hasTrait<mlir::OpTrait::IsTerminator>() ||
      llvm::isa<ir::FrameLoadOp>(op))
    return false;
  auto isConstantForLaunch = [&](mlir::Value address) {
    mlir::Operation *base = ir::baseOperation(address);
    if (ir::isInOutputBuffer(address))
      return false;
    return llvm::isa_and_nonnull<ir::TableOp>(base) ||
           (llvm::isa_and_nonnull<ir::MemberOp, ir::BufferElementOp>(base) &&
            !ir::attr::constructor.isOn(function));
  };
  if (auto load = llvm::dyn_cast<ir::LoadOp>(op)) {
    mlir::Operation *base = ir::baseOperation(load.getAddress());
    if (auto state = llvm::dyn_cast_or_null<ir::StateOp>(base))
      return isUnchanged(load, state.getName(), suspend);
    if (llvm::isa_and_nonnull<ir::PayloadOp>(base)) // rays sent by this one have other payloads
      return isUnchanged(load, payloadName, suspend);
    return isConstantForLaunch(load.getAddress()) || llvm::isa_and_nonnull<ir::AttributeOp>(base);
  }
  if (auto element = llvm::dyn_cast<ir::BufferElementOp>(op))
    return isConstantForLaunch(element.getBuffer());
  if (auto length = llvm::dyn_cast<ir::BufferLengthOp>(op))
    return isConstantForLaunch(length.getBuffer());
  auto [known, isNew] = free.try_emplace(op, false);
  if (isNew)
    known->second = mlir::isMemoryEffectFree(op);
  return known->second;
}

} // namespace rtsl::continuation
