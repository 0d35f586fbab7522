#include "codegen/passes/calls/Operands.h"

#include "codegen/ir/BaseAddress.h"
#include "codegen/ir/MemoryAccesses.h"

#include "mlir/IR/IRMapping.h"
#include "mlir/IR/OperationSupport.h"
#include "mlir/Interfaces/SideEffectInterfaces.h"

namespace rtsl::codegen {

using mlir::Value;

/// Arguments that are computed by more operations, one of another, are left alone.
constexpr unsigned mostSteps = 6;

/// Does it give the same result for the same operands?
static bool isRepeatable(mlir::Operation *op) {
  if (op->getNumResults() != 1 || op->getNumRegions() != 0)
    return false;
  if (auto load = llvm::dyn_cast<ir::LoadOp>(op))
    return ir::locationOf(load.getAddress()).kind == ir::MemoryLocation::Kind::Scene &&
           !ir::isInOutputBuffer(load.getAddress());
  return mlir::isMemoryEffectFree(op);
}

static bool isSame(Value a, Value b, unsigned steps) {
  if (a == b)
    return true;
  mlir::Operation *ofA = a.getDefiningOp(), *ofB = b.getDefiningOp();
  return steps > 0 && ofA && ofB && isRepeatable(ofA) &&
         mlir::OperationEquivalence::isEquivalentTo(
             ofA, ofB,
             [&](Value inA, Value inB) { return mlir::success(isSame(inA, inB, steps - 1)); },
             nullptr, mlir::OperationEquivalence::IgnoreLocations);
}

bool isSame(Value a, Value b) {
  return isSame(a, b, mostSteps);
}

static bool canCompute(Value value, llvm::function_ref<bool(Value)> isKnown, unsigned steps) {
  if (isKnown(value))
    return true;
  mlir::Operation *op = value.getDefiningOp();
  return steps > 0 && op && isRepeatable(op) && llvm::all_of(op->getOperands(), [&](Value operand) {
           return canCompute(operand, isKnown, steps - 1);
         });
}

bool canCompute(Value value, llvm::function_ref<bool(Value)> isKnown) {
  return canCompute(value, isKnown, mostSteps);
}

Value compute(mlir::OpBuilder &builder, Value value, llvm::function_ref<Value(Value)> known) {
  if (const Value there = known(value))
    return there;
  mlir::IRMapping operands;
  for (Value operand : value.getDefiningOp()->getOperands())
    operands.map(operand, compute(builder, operand, known));
  return builder.clone(*value.getDefiningOp(), operands)->getResult(0);
}

} // namespace rtsl::codegen
