#include "codegen/ir/MemoryAccesses.h"

#include "codegen/ir/Attributes.h"
#include "codegen/ir/BaseAddress.h"

#include <algorithm>

namespace rtsl::ir {

void MemoryAccesses::add(const MemoryAccesses &other) {
  reads.insert(other.reads.begin(), other.reads.end());
  writes.insert(other.writes.begin(), other.writes.end());
  readsAny |= other.readsAny;
  writesAny |= other.writesAny;
}

bool conflict(const MemoryAccesses &a, const MemoryAccesses &b) {
  auto common = [](const std::set<MemoryLocation> &x, const std::set<MemoryLocation> &y) {
    return std::any_of(x.begin(), x.end(),
                       [&](const MemoryLocation &location) { return y.count(location) != 0; });
  };
  // Unknown methods reach the ray's state and draw random numbers; variables and the frame are this
  // function's own.
  auto isOpen = [](const std::set<MemoryLocation> &locations) {
    return std::any_of(locations.begin(), locations.end(), [](const MemoryLocation &location) {
      return location.kind == MemoryLocation::Kind::State ||
             location.kind == MemoryLocation::Kind::Random;
    });
  };
  auto writesMeet = [&](const MemoryAccesses &x, const MemoryAccesses &y) {
    return common(x.writes, y.reads) || common(x.writes, y.writes) ||
           (x.writesAny && (y.readsAny || y.writesAny || isOpen(y.reads) || isOpen(y.writes))) ||
           (x.readsAny && isOpen(y.writes));
  };
  return writesMeet(a, b) || writesMeet(b, a);
}

MemoryLocation locationOf(mlir::Value address) {
  using Kind = MemoryLocation::Kind;
  mlir::Operation *op = baseOperation(address);
  if (auto object = llvm::dyn_cast_or_null<FrameObjectOp>(op))
    return {Kind::Object, object.getName().str()};
  if (auto argument = llvm::dyn_cast_or_null<CallArgumentOp>(op))
    return {Kind::Argument, std::to_string(argument.getOffset())};
  if (auto state = llvm::dyn_cast_or_null<StateOp>(op))
    return {Kind::State, state.getName().str()};
  if (llvm::isa_and_nonnull<VarOp>(op))
    return {Kind::Variable, std::to_string(reinterpret_cast<std::uintptr_t>(op))};
  if (llvm::isa_and_nonnull<PayloadOp>(op))
    return {Kind::Payload, {}};
  if (llvm::isa_and_nonnull<AttributeOp>(op))
    return {Kind::Attribute, {}};
  if (llvm::isa_and_nonnull<MemberOp, TableOp, BufferElementOp>(op))
    return {Kind::Scene, {}};
  return {Kind::Unknown, {}};
}

bool changes(EvaluateOp op, std::size_t operand) {
  auto changed = attr::changes.of(op);
  return changed && llvm::is_contained(changed.asArrayRef(), static_cast<std::int32_t>(operand));
}

bool changesNothing(EvaluateOp op) {
  return attr::plain.isOn(op) && !attr::changes.isOn(op) &&
         (!op.getWrites() || op.getWrites()->empty());
}

MemoryAccesses accessesOf(mlir::Operation *op) {
  MemoryAccesses accesses;
  auto addRead = [&](mlir::Value address) {
    const MemoryLocation location = locationOf(address);
    accesses.readsAny |= location.kind == MemoryLocation::Kind::Unknown;
    accesses.reads.insert(location);
  };
  auto addWrite = [&](mlir::Value address) {
    const MemoryLocation location = locationOf(address);
    accesses.writesAny |= location.kind == MemoryLocation::Kind::Unknown;
    accesses.writes.insert(location);
  };
  op->walk([&](mlir::Operation *inner) {
    if (auto load = llvm::dyn_cast<LoadOp>(inner))
      addRead(load.getAddress());
    else if (auto store = llvm::dyn_cast<StoreOp>(inner))
      addWrite(store.getAddress());
    else if (auto frameLoad = llvm::dyn_cast<FrameLoadOp>(inner))
      accesses.reads.insert({MemoryLocation::Kind::Frame, frameLoad.getName().str()});
    else if (auto frameStore = llvm::dyn_cast<FrameStoreOp>(inner))
      accesses.writes.insert({MemoryLocation::Kind::Frame, frameStore.getName().str()});
    else if (llvm::isa<RandOp>(inner))
      accesses.writes.insert({MemoryLocation::Kind::Random, {}});
    else if (auto clear = llvm::dyn_cast<ClearOp>(inner))
      addWrite(clear.getAddress());
    else if (auto copy = llvm::dyn_cast<CopyOp>(inner)) {
      addRead(copy.getSource());
      addWrite(copy.getTarget());
    } else if (auto call = llvm::dyn_cast<EvaluateOp>(inner)) {
      for (auto [index, operand] : llvm::enumerate(call.getOperands()))
        if (llvm::isa<PtrType>(operand.getType())) {
          addRead(operand);
          if (changes(call, index))
            addWrite(operand);
        }
      if (!attr::plain.isOn(call)) {
        accesses.readsAny = true;
        accesses.writes.insert({MemoryLocation::Kind::Random, {}});
        accesses.writesAny |= !call.getWrites();
      }
      if (call.getWrites())
        for (auto name : call.getWrites()->getAsRange<mlir::StringAttr>())
          accesses.writes.insert({MemoryLocation::Kind::State, name.getValue().str()});
    } else if (llvm::isa<IlluminateOp>(inner)) {
      accesses.readsAny = accesses.writesAny = true;
    }
  });
  return accesses;
}

bool writesTo(mlir::Operation *op, mlir::Value address) {
  if (auto store = llvm::dyn_cast<StoreOp>(op))
    return store.getAddress() == address;
  if (auto clear = llvm::dyn_cast<ClearOp>(op))
    return clear.getAddress() == address;
  if (auto copy = llvm::dyn_cast<CopyOp>(op))
    return copy.getTarget() == address;
  if (auto spawn = llvm::dyn_cast<SpawnPayloadOp>(op))
    return spawn.getPayload() == address;
  if (auto call = llvm::dyn_cast<EnterOp>(op))
    return llvm::is_contained(call.getOperands(), address);
  if (auto evaluation = llvm::dyn_cast<EvaluateOp>(op))
    for (auto [index, operand] : llvm::enumerate(evaluation.getOperands()))
      if (operand == address && changes(evaluation, index))
        return true;
  return llvm::isa<FieldOp, ElementOp>(op) &&
         llvm::any_of(op->getUsers(),
                      [&](mlir::Operation *user) { return writesTo(user, op->getResult(0)); });
}

} // namespace rtsl::ir
