//===- TrimPayloads.cpp - pass only the fields that are read --------------===//
//
// A payload is in the frame of the method that sends the ray; the methods that run for the ray read
// and write it there. In a whole program it is known which methods read and write each field:
//
//     struct P {color light; float weight; int depth;}     ==>     struct P {color light;}
//
// - A field that is never read is removed, with all stores to it. Copies from payload to payload of
//   the same field do not count as reads, so a value that is only passed on is removed too.
// - A field that no method of the ray reads or writes need not be in the payload: it becomes a
//   variable of the sender, which is saved across the trace only if it is needed after it, and only
//   if recomputing it is more expensive.
//
// Any other field remains and is passed in both directions: also one that is read, but not after
// the trace, or written, but not set before.
//
//===----------------------------------------------------------------------===//
#include "codegen/ir/Layout.h"
#include "codegen/passes/continuation/save/Steps.h"

#include "mlir/IR/Dominance.h"
#include "mlir/Interfaces/DataLayoutInterfaces.h"
#include "mlir/Transforms/Mem2Reg.h"
#include "llvm/ADT/MapVector.h"
#include "llvm/ADT/SetVector.h"

namespace rtsl::continuation {

using mlir::Value;

namespace {

/// Uses of one field of a payload type.
struct FieldUse {
  bool isRead = false;     // other than to be passed on
  bool byPrograms = false; // read or written by methods that run for the ray
};

class PayloadTrimmer {
public:
  PayloadTrimmer(mlir::ModuleOp module, ir::StructType type)
      : module(module), type(type), uses(type.getFieldNames().size()) {}

  /// Returns the removed fields.
  TrimmedPayload run();

private:
  bool findBases();
  void look(Value address, unsigned field, bool ofProgram);
  bool isOwnField(Value address, unsigned field);
  llvm::SmallVector<ir::FieldOp> accessesOf(unsigned field);
  void makeVariables(unsigned field);
  void eraseAccesses(unsigned field);
  ir::StructType changeType(llvm::ArrayRef<unsigned> kept);

  mlir::ModuleOp module;
  ir::StructType type;
  llvm::SetVector<mlir::Operation *>
      bases; // base addresses of payloads: `rtsl.payload` or a variable
  std::vector<FieldUse> uses;
};

mlir::Type pointeeOf(Value address) {
  auto pointer = llvm::dyn_cast<ir::PtrType>(address.getType());
  return pointer ? pointer.getPointee() : mlir::Type();
}

/// Finds all payloads of the type. False if one has an unknown use.
bool PayloadTrimmer::findBases() {
  bool isUnderstood = true;
  module.walk([&](mlir::Operation *op) {
    for (Value result : op->getResults()) {
      if (pointeeOf(result) != type)
        continue;
      isUnderstood &= llvm::isa<ir::PayloadOp, ir::VarOp>(op);
      bases.insert(op);
      for (mlir::Operation *user : result.getUsers())
        isUnderstood &= llvm::isa<ir::FieldOp, ir::TracePayloadOp>(user);
    }
    for (mlir::Region &region : op->getRegions())
      for (mlir::Block &block : region)
        for (mlir::BlockArgument argument : block.getArguments())
          isUnderstood &= pointeeOf(argument) != type;
  });
  return isUnderstood;
}

/// Is this the address of the field in a payload of the type?
bool PayloadTrimmer::isOwnField(Value address, unsigned field) {
  auto access = address.getDefiningOp<ir::FieldOp>();
  return access && pointeeOf(access.getBase()) == type &&
         type.fieldIndex(access.getField()) == field;
}

void PayloadTrimmer::look(Value address, unsigned field, bool ofProgram) {
  for (mlir::Operation *user : address.getUsers()) {
    if (llvm::isa<ir::FieldOp, ir::ElementOp>(user)) {
      look(user->getResult(0), field, ofProgram);
    } else if (llvm::isa<ir::LoadOp>(user)) {
      const bool isHandedOn = llvm::all_of(user->getUsers(), [&](mlir::Operation *reader) {
        auto store = llvm::dyn_cast<ir::StoreOp>(reader);
        return store && isOwnField(address, field) && isOwnField(store.getAddress(), field);
      });
      uses[field].isRead |= !isHandedOn;
      uses[field].byPrograms |= ofProgram;
    } else {
      auto store = llvm::dyn_cast<ir::StoreOp>(user);
      uses[field].isRead |= !store || store.getAddress() != address;
      uses[field].byPrograms |= ofProgram;
    }
  }
}

/// The accesses of a field in all payloads, in order.
llvm::SmallVector<ir::FieldOp> PayloadTrimmer::accessesOf(unsigned field) {
  llvm::SmallVector<ir::FieldOp> accesses;
  for (mlir::Operation *base : bases)
    for (mlir::Operation *user : base->getUsers())
      if (auto access = llvm::dyn_cast<ir::FieldOp>(user);
          access && type.fieldIndex(access.getField()) == field)
        accesses.push_back(access);
  return accesses;
}

/// A field that only the sender uses becomes a variable, which is then promoted to values.
void PayloadTrimmer::makeVariables(unsigned field) {
  llvm::MapVector<mlir::Operation *, ir::VarOp> own;
  mlir::OpBuilder builder(module.getContext());
  for (ir::FieldOp access : accessesOf(field)) {
    auto payload = access.getBase().getDefiningOp<ir::VarOp>();
    ir::VarOp &variable = own[payload];
    if (!variable) {
      builder.setInsertionPoint(payload);
      variable = ir::VarOp::create(
          builder, payload.getLoc(), ir::PtrType::get(type.getFieldTypes()[field]),
          (payload.getName() + "." + type.getFieldNames()[field].getValue()).str());
    }
    access.replaceAllUsesWith(variable.getResult());
    access.erase();
  }
  for (auto &[payload, variable] : own) {
    auto function = payload->getParentOfType<FuncOp>();
    mlir::DominanceInfo dominance(function);
    (void)mlir::tryToPromoteMemorySlots(
        llvm::cast<mlir::PromotableAllocationOpInterface>(variable.getOperation()), builder,
        mlir::DataLayout::closest(function), dominance);
  }
}

/// Erases all accesses of a field that is never read, and loads that only pass it on.
void PayloadTrimmer::eraseAccesses(unsigned field) {
  llvm::SetVector<mlir::Operation *> erased;
  for (ir::FieldOp access : accessesOf(field))
    erased.insert(access);
  for (std::size_t i = 0; i < erased.size(); ++i)
    erased.insert(erased[i]->user_begin(), erased[i]->user_end());
  for (mlir::Operation *op : erased)
    op->dropAllReferences();
  for (mlir::Operation *op : erased)
    op->erase();
}

ir::StructType PayloadTrimmer::changeType(llvm::ArrayRef<unsigned> kept) {
  llvm::SmallVector<mlir::StringAttr> names;
  llvm::SmallVector<mlir::Type> types;
  for (unsigned field : kept) {
    names.push_back(type.getFieldNames()[field]);
    types.push_back(type.getFieldTypes()[field]);
  }
  const auto smaller = ir::StructType::get(type.getContext(), type.getName(), names, types);
  for (mlir::Operation *base : bases)
    base->getResult(0).setType(ir::PtrType::get(smaller));
  return smaller;
}

/// Returns no fields if none is removed.
TrimmedPayload PayloadTrimmer::run() {
  if (!findBases())
    return {};
  for (mlir::Operation *base : bases)
    for (mlir::Operation *user : base->getUsers())
      if (auto access = llvm::dyn_cast<ir::FieldOp>(user))
        look(access, *type.fieldIndex(access.getField()), llvm::isa<ir::PayloadOp>(base));

  std::vector<std::string> dropped;
  llvm::SmallVector<unsigned> kept;
  for (unsigned field = 0; field < uses.size(); ++field)
    if (uses[field].isRead && uses[field].byPrograms)
      kept.push_back(field);
    else
      dropped.push_back(type.getFieldNames()[field].str());
  if (dropped.empty() || kept.empty()) // a payload keeps at least one field
    return {};
  for (unsigned field = 0; field < uses.size(); ++field) {
    if (!uses[field].isRead)
      eraseAccesses(field);
    else if (!uses[field].byPrograms)
      makeVariables(field);
  }
  return {type.getName().str(), std::move(dropped), ir::sizeInBytes(type),
          ir::sizeInBytes(changeType(kept))};
}

} // namespace

std::vector<TrimmedPayload> trimPayloads(mlir::ModuleOp module) {
  llvm::SetVector<mlir::Type> types;
  bool isLinked = true;
  module.walk([&](ir::TracePayloadOp trace) {
    isLinked &= trace.getRayType().has_value();
    types.insert(pointeeOf(trace.getPayload()));
  });
  std::vector<TrimmedPayload> trimmed;
  if (!isLinked) // unlinked classes may read the fields
    return trimmed;
  for (mlir::Type type : types) {
    TrimmedPayload payload = PayloadTrimmer(module, llvm::cast<ir::StructType>(type)).run();
    if (!payload.fields.empty())
      trimmed.push_back(std::move(payload));
  }
  return trimmed;
}

} // namespace rtsl::continuation
