//===- TrimPayloads.cpp - pass only the fields that somebody reads --------===//
//
// A payload lies in the frame of who sends the ray; its programs read and write it there. Over a
// whole program it is known who reads which field, and who writes it:
//
//     struct P {color light; float weight; int depth;}     ==>     struct P {color light;}
//
// - A field that nobody reads is gone, with all stores to it. Copies from payload to payload of the
//   same field are no reads, so a value that is only handed on and on is gone too.
// - A field that no program of the ray reads or writes is not the ray's: it is a variable of who
//   sends it, which is kept across the trace only if it is needed behind, and only if that is
//   cheaper than to compute it again.
//
// A field that programs read but nobody reads behind the trace, or that they write but that nobody
// sets before, has to have its place all the same: so each field that is left is passed both ways.
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

/// What is done with one field of a type of payload.
struct FieldUse {
  bool isRead = false;     // for more than to be handed on
  bool byPrograms = false; // read or written where the ray arrives
};

class PayloadTrimmer {
public:
  PayloadTrimmer(mlir::ModuleOp module, ir::StructType type)
      : module(module), type(type), uses(type.getFieldNames().size()) {}

  /// The names of the fields that are not passed any more.
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
  llvm::SetVector<mlir::Operation *> bases; // addresses of payloads: `rtsl.payload` or a variable
  std::vector<FieldUse> uses;
};

mlir::Type pointeeOf(Value address) {
  auto pointer = llvm::dyn_cast<ir::PtrType>(address.getType());
  return pointer ? pointer.getPointee() : mlir::Type();
}

/// All payloads of the type. False if one is used in a way that is not understood.
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

/// Is this the address of the field in some payload of the type?
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

/// The accesses of a field in all payloads, as they stand.
llvm::SmallVector<ir::FieldOp> PayloadTrimmer::accessesOf(unsigned field) {
  llvm::SmallVector<ir::FieldOp> accesses;
  for (mlir::Operation *base : bases)
    for (mlir::Operation *user : base->getUsers())
      if (auto access = llvm::dyn_cast<ir::FieldOp>(user);
          access && type.fieldIndex(access.getField()) == field)
        accesses.push_back(access);
  return accesses;
}

/// A field that only who sends the ray uses becomes a variable of its own, and then values.
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

/// All accesses of a field that nobody reads, and what is only read to be handed on.
void PayloadTrimmer::eraseAccesses(unsigned field) {
  llvm::SetVector<mlir::Operation *> gone;
  for (ir::FieldOp access : accessesOf(field))
    gone.insert(access);
  for (std::size_t i = 0; i < gone.size(); ++i)
    gone.insert(gone[i]->user_begin(), gone[i]->user_end());
  for (mlir::Operation *op : gone)
    op->dropAllReferences();
  for (mlir::Operation *op : gone)
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

/// Without fields if nothing is taken out.
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
  if (dropped.empty() || kept.empty()) // the ray carries something, if only its type
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
  if (!isLinked) // other classes may come that read the rest
    return trimmed;
  for (mlir::Type type : types) {
    TrimmedPayload payload = PayloadTrimmer(module, llvm::cast<ir::StructType>(type)).run();
    if (!payload.fields.empty())
      trimmed.push_back(std::move(payload));
  }
  return trimmed;
}

} // namespace rtsl::continuation
