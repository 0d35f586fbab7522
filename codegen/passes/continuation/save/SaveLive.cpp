//===- SaveLive.cpp - values live across a trace, by name -----------------===//
//
//     rtsl.suspend %o, %d, ^resume               rtsl.suspend %o, %d, ^resume(%i : i32) names ["i"]
//   ^resume:                             ==>   ^resume(%i' : i32):
//     use %i                                     use %i'
//
// Afterwards, except for the object of the method, no value that is defined before a suspend is
// used after it, so that each state can be separated.
//
//===----------------------------------------------------------------------===//
#include "codegen/ir/NamedLocation.h"
#include "codegen/passes/continuation/common/Liveness.h"
#include "codegen/passes/continuation/common/Names.h"
#include "codegen/passes/continuation/common/SsaRepair.h"
#include "codegen/passes/continuation/save/Steps.h"

namespace rtsl::continuation {

mlir::LogicalResult saveLive(FuncOp function) {
  llvm::SmallVector<ir::SuspendOp> suspends = suspendsOf(function);
  if (suspends.empty())
    return mlir::success();
  Liveness liveness(function);
  liveness.compute();
  llvm::SmallVector<llvm::SmallVector<mlir::Value>> saved;
  for (ir::SuspendOp suspend : suspends)
    saved.push_back(liveness.valuesOf(liveness.into(suspend.getResume())));

  UniqueNames names;
  llvm::MapVector<mlir::Value, Redefinitions> redefinitions;
  for (auto [suspend, values] : llvm::zip(suspends, saved)) {
    llvm::SmallVector<mlir::Attribute> namesHere;
    for (mlir::Value value : values) {
      if (!ir::isValueType(value.getType()))
        return mlir::emitError(suspend.getLoc())
               << "the address `" << sourceName(value) << "` is used after a trace";
      const std::string &name = names.of(value);
      auto nameAttr = mlir::StringAttr::get(function.getContext(), name);
      namesHere.push_back(nameAttr);
      redefinitions[value][suspend.getResume()] = suspend.getResume()->addArgument(
          value.getType(),
          ir::withName({name, ir::nameIn(value.getLoc()).isOfShortCircuit}, value.getLoc()));
    }
    suspend.setNamesAttr(mlir::ArrayAttr::get(function.getContext(), namesHere));
    suspend.getSavedMutable().assign(values);
  }
  const BlockOrder order(function.getBody());
  for (auto &[value, ofValue] : redefinitions)
    repairSsa(value, ofValue, order);
  return mlir::success();
}

} // namespace rtsl::continuation
