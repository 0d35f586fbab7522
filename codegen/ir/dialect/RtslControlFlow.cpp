//===- RtslControlFlow.cpp - the structured operations of level 1 ---------===//
#include "codegen/ir/dialect/RtslOps.h"

#include "mlir/Interfaces/FunctionInterfaces.h"

namespace rtsl::ir {

using mlir::LogicalResult;

void SwitchOp::build(mlir::OpBuilder &builder, mlir::OperationState &state, mlir::Value value,
                     llvm::ArrayRef<llvm::SmallVector<int32_t>> values,
                     std::optional<unsigned> defaultArm) {
  llvm::SmallVector<mlir::Attribute> allValues;
  for (const auto &ofArm : values) {
    allValues.push_back(builder.getDenseI32ArrayAttr(ofArm));
    state.addRegion()->emplaceBlock();
  }
  state.addOperands(value);
  state.addAttribute(getValuesAttrName(state.name), builder.getArrayAttr(allValues));
  if (defaultArm)
    state.addAttribute(getDefaultArmAttrName(state.name), builder.getI32IntegerAttr(*defaultArm));
}

llvm::ArrayRef<int32_t> SwitchOp::armValues(unsigned index) {
  return llvm::cast<mlir::DenseI32ArrayAttr>(getValues()[index]).asArrayRef();
}

LogicalResult SwitchOp::verify() {
  if (getValues().size() != getArms().size())
    return emitOpError() << "has " << getArms().size() << " arms, but values for "
                         << getValues().size();
  if (getDefaultArm() && *getDefaultArm() >= getArms().size())
    return emitOpError() << "has no arm " << *getDefaultArm() << ", which is to be the default";
  llvm::SmallVector<int32_t> seen;
  for (unsigned arm = 0; arm < getArms().size(); ++arm) {
    if (!llvm::isa<mlir::DenseI32ArrayAttr>(getValues()[arm]))
      return emitOpError() << "must list the values of an arm as array<i32: ...>";
    for (int32_t value : armValues(arm)) {
      if (llvm::is_contained(seen, value))
        return emitOpError() << "lists the value " << value << " twice";
      seen.push_back(value);
    }
  }
  return mlir::success();
}

//===----------------------------------------------------------------------===//
// Regions and their terminators
//===----------------------------------------------------------------------===//

LogicalResult LoopOp::verifyRegions() {
  if (!getCondition().empty() && !llvm::isa<ConditionOp>(getCondition().front().back()))
    return emitOpError() << "has a `cond` that does not end in `rtsl.condition`";
  if (!getStep().empty() && !llvm::isa<YieldOp>(getStep().front().back()))
    return emitOpError() << "has a `step` that does not end in `rtsl.yield`";
  if (llvm::isa<ConditionOp>(getBody().front().back()))
    return emitOpError() << "has a body that ends in `rtsl.condition`, which is only for `cond`";
  return mlir::success();
}

LogicalResult IlluminanceOp::verify() {
  if (!getNormal() != !getCosAngle())
    return emitOpError() << "takes `normal` and `cos` together";
  return mlir::success();
}

/// Finds the op that a `rtsl.break` or `rtsl.continue` belongs to.
static LogicalResult verifyJump(mlir::Operation *op, bool switchCounts) {
  mlir::Region *region = op->getParentRegion();
  while (mlir::Operation *parent = region->getParentOp()) {
    if (auto loop = llvm::dyn_cast<LoopOp>(parent)) {
      if (region == &loop.getBody())
        return mlir::success();
      return op->emitOpError() << "is in a loop's `cond` or `step`; it is only for the body";
    }
    if (llvm::isa<IlluminanceOp>(parent) || (switchCounts && llvm::isa<SwitchOp>(parent)))
      return mlir::success();
    if (!llvm::isa<IfOp, SwitchOp>(parent))
      break;
    region = parent->getParentRegion();
  }
  return op->emitOpError() << "is in no loop"
                           << (switchCounts ? ", illuminance or switch" : " or illuminance");
}

LogicalResult BreakOp::verify() {
  return verifyJump(*this, /*switchCounts=*/true);
}
LogicalResult ContinueOp::verify() {
  return verifyJump(*this, /*switchCounts=*/false);
}

LogicalResult ReturnOp::verify() {
  auto function = (*this)->getParentOfType<mlir::FunctionOpInterface>();
  if (!function)
    return emitOpError() << "is in no function";
  for (mlir::Region *region = (*this)->getParentRegion(); region->getParentOp() != function;
       region = region->getParentOp()->getParentRegion()) {
    if (!llvm::isa<IfOp, LoopOp, SwitchOp, IlluminanceOp>(region->getParentOp()))
      return emitOpError() << "is in `" << region->getParentOp()->getName()
                           << "`, which it cannot leave";
  }
  if (llvm::ArrayRef<mlir::Type> expected = function.getResultTypes();
      mlir::TypeRange(expected) != getOperandTypes()) {
    auto diagnostic = emitOpError() << "has ";
    if (getValues().empty())
      diagnostic << "no value";
    else
      diagnostic << "values of type " << getOperandTypes();
    diagnostic << "; the function returns ";
    if (expected.empty())
      return diagnostic << "nothing";
    return diagnostic << expected;
  }
  return mlir::success();
}

} // namespace rtsl::ir
