//===- RtslMemorySlots.cpp - promotion of variables to values -------------===//
//
// The interfaces with which MLIR's `sroa` splits a variable into parts and `mem2reg` promotes the
// parts to SSA values. Parts are always visited in the order of the type: sets of attributes are
// ordered by address, and output must be the same on every run.
//
//===----------------------------------------------------------------------===//
#include "codegen/ir/NamedLocation.h"
#include "codegen/ir/dialect/RtslOps.h"

#include "mlir/Dialect/Arith/IR/Arith.h"

namespace rtsl::ir {

using mlir::DeletionKind;
using mlir::DestructurableMemorySlot;
using mlir::LogicalResult;
using mlir::MemorySlot;
using mlir::OpBuilder;
using mlir::OpOperand;
using mlir::Value;

using Blocking = const llvm::SmallPtrSetImpl<OpOperand *> &;
using NewBlocking = llvm::SmallVectorImpl<OpOperand *> &;
using UsedIndices = llvm::SmallPtrSetImpl<mlir::Attribute> &;
using SafeSlots = llvm::SmallVectorImpl<MemorySlot> &;
using Subslots = llvm::DenseMap<mlir::Attribute, MemorySlot>;

/// The indices of an aggregate's parts, in order.
static llvm::SmallVector<mlir::Attribute> partIndices(mlir::Type type) {
  llvm::SmallVector<mlir::Attribute> indices;
  if (auto structure = llvm::dyn_cast<StructType>(type)) {
    indices.assign(structure.getFieldNames().begin(), structure.getFieldNames().end());
  } else if (auto array = llvm::dyn_cast<ArrayType>(type)) {
    mlir::Builder builder(type.getContext());
    for (unsigned index = 0; index < array.getLength(); ++index)
      indices.push_back(builder.getI32IntegerAttr(index));
  }
  return indices;
}

/// The address of the part of `base` that has this index.
static Value partAddress(OpBuilder &builder, mlir::Location location, Value base,
                         mlir::Attribute index) {
  if (auto field = llvm::dyn_cast<mlir::StringAttr>(index))
    return FieldOp::create(builder, location, base, field.getValue());
  auto number =
      mlir::arith::ConstantOp::create(builder, location, llvm::cast<mlir::IntegerAttr>(index));
  return ElementOp::create(builder, location, base, number);
}

//===----------------------------------------------------------------------===//
// rtsl.var
//===----------------------------------------------------------------------===//

llvm::SmallVector<MemorySlot> VarOp::getPromotableSlots() {
  mlir::Type type = pointee(getResult());
  if (!isValueType(type))
    return {};
  return {MemorySlot{getResult(), type}};
}

Value VarOp::getDefaultValue(const MemorySlot &slot, OpBuilder &builder) {
  return createZero(builder, getLoc(), slot.elemType);
}

// Values are shown to the author under the name of the variable that they were promoted from.

void VarOp::handleBlockArgument(const MemorySlot &, mlir::BlockArgument argument, OpBuilder &) {
  argument.setLoc(withNameOf(*this, argument.getLoc()));
}

std::optional<mlir::PromotableAllocationOpInterface>
VarOp::handlePromotionComplete(const MemorySlot &, Value defaultValue, OpBuilder &) {
  if (defaultValue && defaultValue.use_empty())
    defaultValue.getDefiningOp()->erase();
  erase();
  return std::nullopt;
}

llvm::SmallVector<DestructurableMemorySlot> VarOp::getDestructurableSlots() {
  mlir::Type type = pointee(getResult());
  auto destructurable = llvm::dyn_cast<mlir::DestructurableTypeInterface>(type);
  if (!destructurable)
    return {};
  auto parts = destructurable.getSubelementIndexMap();
  if (!parts)
    return {};
  return {DestructurableMemorySlot{{getResult(), type}, std::move(*parts)}};
}

Subslots
VarOp::destructure(const DestructurableMemorySlot &slot,
                   const llvm::SmallPtrSetImpl<mlir::Attribute> &usedIndices, OpBuilder &builder,
                   llvm::SmallVectorImpl<mlir::DestructurableAllocationOpInterface> &newVars) {
  builder.setInsertionPointAfter(*this);
  Subslots subslots;
  for (mlir::Attribute index : partIndices(slot.elemType)) {
    if (!usedIndices.contains(index))
      continue;
    std::string name = getName().str();
    if (auto field = llvm::dyn_cast<mlir::StringAttr>(index))
      name += "." + field.getValue().str();
    else
      name += "[" + std::to_string(llvm::cast<mlir::IntegerAttr>(index).getInt()) + "]";
    mlir::Type type = slot.subelementTypes.lookup(index);
    auto part = VarOp::create(builder, getLoc(), name, type);
    newVars.push_back(part);
    subslots[index] = MemorySlot{part.getResult(), type};
  }
  return subslots;
}

std::optional<mlir::DestructurableAllocationOpInterface>
VarOp::handleDestructuringComplete(const DestructurableMemorySlot &, OpBuilder &) {
  erase();
  return std::nullopt;
}

//===----------------------------------------------------------------------===//
// rtsl.load, rtsl.store, rtsl.clear
//===----------------------------------------------------------------------===//

/// Whether the only use that blocks promotion is as the address of `op`.
static bool blocksByAddress(Value address, const MemorySlot &slot, Blocking blockingUses) {
  return blockingUses.size() == 1 && (*blockingUses.begin())->get() == slot.ptr &&
         address == slot.ptr && pointee(address) == slot.elemType;
}

/// An access of the whole slot does not reach beyond it.
static LogicalResult isInside(Value address, const MemorySlot &slot) {
  return mlir::success(address == slot.ptr && pointee(address) == slot.elemType);
}

bool LoadOp::loadsFrom(const MemorySlot &slot) {
  return getAddress() == slot.ptr;
}
bool LoadOp::storesTo(const MemorySlot &) {
  return false;
}
Value LoadOp::getStored(const MemorySlot &, OpBuilder &, Value, const mlir::DataLayout &) {
  llvm_unreachable("a load stores nothing");
}
bool LoadOp::canUsesBeRemoved(const MemorySlot &slot, Blocking blockingUses, NewBlocking,
                              const mlir::DataLayout &) {
  return blocksByAddress(getAddress(), slot, blockingUses);
}
DeletionKind LoadOp::removeBlockingUses(const MemorySlot &, Blocking, OpBuilder &,
                                        Value reachingDefinition, const mlir::DataLayout &) {
  getResult().replaceAllUsesWith(reachingDefinition);
  return DeletionKind::Delete;
}
LogicalResult LoadOp::ensureOnlySafeAccesses(const MemorySlot &slot, SafeSlots,
                                             const mlir::DataLayout &) {
  return isInside(getAddress(), slot);
}

bool StoreOp::loadsFrom(const MemorySlot &) {
  return false;
}
bool StoreOp::storesTo(const MemorySlot &slot) {
  return getAddress() == slot.ptr;
}
Value StoreOp::getStored(const MemorySlot &, OpBuilder &, Value, const mlir::DataLayout &) {
  return getValue();
}
bool StoreOp::canUsesBeRemoved(const MemorySlot &slot, Blocking blockingUses, NewBlocking,
                               const mlir::DataLayout &) {
  return blocksByAddress(getAddress(), slot, blockingUses);
}
DeletionKind StoreOp::removeBlockingUses(const MemorySlot &slot, Blocking, OpBuilder &, Value,
                                         const mlir::DataLayout &) {
  // A constant has many uses, so it does not get the variable's name.
  mlir::Operation *op = getValue().getDefiningOp();
  if (op && !op->hasTrait<mlir::OpTrait::ConstantLike>())
    op->setLoc(withNameOf(slot.ptr.getDefiningOp<VarOp>(), op->getLoc()));
  return DeletionKind::Delete;
}
LogicalResult StoreOp::ensureOnlySafeAccesses(const MemorySlot &slot, SafeSlots,
                                              const mlir::DataLayout &) {
  return isInside(getAddress(), slot);
}

bool ClearOp::loadsFrom(const MemorySlot &) {
  return false;
}
bool ClearOp::storesTo(const MemorySlot &slot) {
  return getAddress() == slot.ptr;
}
Value ClearOp::getStored(const MemorySlot &slot, OpBuilder &builder, Value,
                         const mlir::DataLayout &) {
  return createZero(builder, getLoc(), slot.elemType);
}
bool ClearOp::canUsesBeRemoved(const MemorySlot &slot, Blocking blockingUses, NewBlocking,
                               const mlir::DataLayout &) {
  return blocksByAddress(getAddress(), slot, blockingUses);
}
DeletionKind ClearOp::removeBlockingUses(const MemorySlot &, Blocking, OpBuilder &, Value,
                                         const mlir::DataLayout &) {
  return DeletionKind::Delete;
}
LogicalResult ClearOp::ensureOnlySafeAccesses(const MemorySlot &slot, SafeSlots,
                                              const mlir::DataLayout &) {
  return isInside(getAddress(), slot);
}
bool ClearOp::canRewire(const DestructurableMemorySlot &slot, UsedIndices, SafeSlots,
                        const mlir::DataLayout &) {
  return getAddress() == slot.ptr;
}
DeletionKind ClearOp::rewire(const DestructurableMemorySlot &slot, Subslots &subslots,
                             OpBuilder &builder, const mlir::DataLayout &) {
  for (mlir::Attribute index : partIndices(slot.elemType))
    if (auto part = subslots.find(index); part != subslots.end())
      ClearOp::create(builder, getLoc(), part->second.ptr);
  return DeletionKind::Delete;
}

//===----------------------------------------------------------------------===//
// rtsl.copy
//===----------------------------------------------------------------------===//

LogicalResult CopyOp::ensureOnlySafeAccesses(const MemorySlot &slot, SafeSlots,
                                             const mlir::DataLayout &) {
  return mlir::success(pointee(getSource()) == slot.elemType);
}

bool CopyOp::canRewire(const DestructurableMemorySlot &slot, UsedIndices usedIndices, SafeSlots,
                       const mlir::DataLayout &) {
  if (getSource() != getTarget())
    for (mlir::Attribute index : partIndices(slot.elemType))
      usedIndices.insert(index);
  return true;
}

/// One copy for each part. The other side is accessed through its address; if it is a variable too,
/// it is split later.
DeletionKind CopyOp::rewire(const DestructurableMemorySlot &slot, Subslots &subslots,
                            OpBuilder &builder, const mlir::DataLayout &) {
  if (getSource() == getTarget())
    return DeletionKind::Delete;
  for (mlir::Attribute index : partIndices(slot.elemType)) {
    Value part = subslots.lookup(index).ptr;
    Value source =
        getSource() == slot.ptr ? part : partAddress(builder, getLoc(), getSource(), index);
    Value target =
        getTarget() == slot.ptr ? part : partAddress(builder, getLoc(), getTarget(), index);
    if (isValueType(pointee(part)))
      StoreOp::create(builder, getLoc(), LoadOp::create(builder, getLoc(), source), target);
    else
      CopyOp::create(builder, getLoc(), source, target);
  }
  return DeletionKind::Delete;
}

//===----------------------------------------------------------------------===//
// rtsl.field, rtsl.element
//===----------------------------------------------------------------------===//

LogicalResult FieldOp::ensureOnlySafeAccesses(const MemorySlot &slot, SafeSlots mustBeSafelyUsed,
                                              const mlir::DataLayout &) {
  mustBeSafelyUsed.push_back({getResult(), pointee(getResult())});
  return isInside(getBase(), slot);
}

bool FieldOp::canRewire(const DestructurableMemorySlot &slot, UsedIndices usedIndices,
                        SafeSlots mustBeSafelyUsed, const mlir::DataLayout &) {
  if (!slot.subelementTypes.contains(getFieldAttr()))
    return false;
  usedIndices.insert(getFieldAttr());
  mustBeSafelyUsed.push_back({getResult(), pointee(getResult())});
  return true;
}

DeletionKind FieldOp::rewire(const DestructurableMemorySlot &, Subslots &subslots, OpBuilder &,
                             const mlir::DataLayout &) {
  getResult().replaceAllUsesWith(subslots.lookup(getFieldAttr()).ptr);
  return DeletionKind::Delete;
}

LogicalResult ElementOp::ensureOnlySafeAccesses(const MemorySlot &slot, SafeSlots mustBeSafelyUsed,
                                                const mlir::DataLayout &) {
  // The op itself requires that the index is in range.
  mustBeSafelyUsed.push_back({getResult(), pointee(getResult())});
  return isInside(getBase(), slot);
}

bool ElementOp::canRewire(const DestructurableMemorySlot &slot, UsedIndices usedIndices,
                          SafeSlots mustBeSafelyUsed, const mlir::DataLayout &) {
  std::optional<int32_t> index = constantIndex();
  if (!index)
    return false;
  auto attribute = mlir::Builder(getContext()).getI32IntegerAttr(*index);
  if (!slot.subelementTypes.contains(attribute))
    return false;
  usedIndices.insert(attribute);
  mustBeSafelyUsed.push_back({getResult(), pointee(getResult())});
  return true;
}

DeletionKind ElementOp::rewire(const DestructurableMemorySlot &, Subslots &subslots, OpBuilder &,
                               const mlir::DataLayout &) {
  auto attribute = mlir::Builder(getContext()).getI32IntegerAttr(*constantIndex());
  getResult().replaceAllUsesWith(subslots.lookup(attribute).ptr);
  return DeletionKind::Delete;
}

} // namespace rtsl::ir
