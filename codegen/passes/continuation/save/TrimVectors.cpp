//===- TrimVectors.cpp - save only the components that are read -----------===//
//
//   %v = ...                                   %v = ...
//   a trace                                    %x = vector.extract %v[0]
//   %x = vector.extract %v[0]        ==>       a trace
//   use %x                                     use %x
//
// If only some components of a vector are read after a trace, these components are live across it
// instead. If the whole vector is needed too, the minimum cut recomputes the component, because
// extracting it is free. To see components through arithmetic, an operation on vectors of whose
// result only some components are read is first narrowed to those.
//
//===----------------------------------------------------------------------===//
#include "codegen/passes/continuation/common/Liveness.h"
#include "codegen/passes/continuation/save/Steps.h"

#include "mlir/Dialect/Arith/IR/Arith.h"
#include "mlir/Dialect/Vector/IR/VectorOps.h"

#include <map>

namespace rtsl::continuation {

namespace vector = mlir::vector;

/// The constant component that an extract takes; -1 if it is not constant.
static std::int64_t componentOf(vector::ExtractOp extract) {
  if (extract.hasDynamicPosition() || extract.getStaticPosition().size() != 1)
    return -1;
  return extract.getStaticPosition().front();
}

static bool isComponentwise(mlir::Operation *op) {
  return op->getNumResults() == 1 && op->getNumRegions() == 0 &&
         (mlir::OpTrait::hasElementwiseMappableTraits(op) || llvm::isa<ir::ElementaryOp>(op)) &&
         llvm::all_of(op->getOperandTypes(),
                      [](mlir::Type type) { return llvm::isa<mlir::VectorType>(type); });
}

/// Narrows `op` to the components that are read, if these are not all.
static bool narrow(mlir::Operation *op) {
  if (!isComponentwise(op) || op->use_empty())
    return false;
  auto type = llvm::dyn_cast<mlir::VectorType>(op->getResult(0).getType());
  if (!type)
    return false;
  std::map<std::int64_t, mlir::Value> components;
  for (mlir::Operation *user : op->getUsers()) {
    auto extract = llvm::dyn_cast<vector::ExtractOp>(user);
    std::int64_t component = extract ? componentOf(extract) : -1;
    if (component < 0)
      return false;
    components[component];
  }
  if (static_cast<std::int64_t>(components.size()) == type.getNumElements())
    return false;

  mlir::OpBuilder builder(op);
  for (auto &[component, value] : components) {
    llvm::SmallVector<mlir::Value> operands;
    for (mlir::Value operand : op->getOperands())
      operands.push_back(builder.createOrFold<vector::ExtractOp>(op->getLoc(), operand, component));
    mlir::OperationState state(op->getLoc(), op->getName(), operands, {type.getElementType()},
                               op->getAttrs());
    state.propertiesAttr = op->getPropertiesAsAttribute();
    value = builder.create(state)->getResult(0);
  }
  for (mlir::Operation *user : llvm::make_early_inc_range(op->getUsers())) {
    user->getResult(0).replaceAllUsesWith(
        components[componentOf(llvm::cast<vector::ExtractOp>(user))]);
    user->erase();
  }
  op->erase();
  return true;
}

/// Whether extracting early may reduce liveness: `op` extracts from a single vector.
static bool isPart(mlir::Operation &op) {
  if (auto extract = llvm::dyn_cast<vector::ExtractOp>(op))
    return componentOf(extract) >= 0;
  auto shuffle = llvm::dyn_cast<vector::ShuffleOp>(op);
  return shuffle && shuffle.getV1() == shuffle.getV2() &&
         shuffle.getResultVectorType().getNumElements() <
             shuffle.getV1VectorType().getNumElements();
}

void trimVectors(FuncOp function) {
  if (suspendsOf(function).empty())
    return;
  llvm::SmallVector<mlir::Operation *> operations;
  function.walk([&](mlir::Operation *op) {
    if (!llvm::isa<vector::ExtractOp>(op)) // these move together with their operand
      operations.push_back(op);
  });
  for (mlir::Operation *op : llvm::reverse(operations)) // users first: then they read extracts
    narrow(op);

  Liveness liveness(function);
  liveness.compute();
  llvm::BitVector acrossTraces = liveness.none();
  for (ir::SuspendOp suspend : suspendsOf(function))
    acrossTraces |= liveness.into(suspend.getResume());

  llvm::DenseMap<mlir::Block *, unsigned> blockNumbers;
  for (mlir::Block &block : function.getBody())
    blockNumbers.try_emplace(&block, blockNumbers.size());
  const auto isBefore = [&](mlir::Operation *a, mlir::Operation *b) {
    return a->getBlock() == b->getBlock()
               ? a->isBeforeInBlock(b)
               : blockNumbers.lookup(a->getBlock()) < blockNumbers.lookup(b->getBlock());
  };
  llvm::DenseMap<mlir::Value, mlir::Value> replaced; // extracts may have extracts
  for (mlir::Value live : liveness.valuesOf(acrossTraces)) {
    const auto other = replaced.find(live);
    mlir::Value whole = other != replaced.end() ? other->second : live;
    llvm::SmallVector<mlir::Operation *>
        parts; // in program order; an extract has no other uses of its operand
    for (mlir::Operation *user : whole.getUsers())
      if (isPart(*user) && user->getOperand(0) == whole &&
          user->getBlock() != whole.getParentBlock() &&
          !llvm::is_contained(parts, user)) // a shuffle may use its operand twice
        parts.push_back(user);
    llvm::sort(parts, isBefore);
    for (mlir::Operation *part : parts) {
      // An equal extract that is already there, or was moved before.
      mlir::Operation *same = nullptr;
      for (mlir::Operation *user : whole.getUsers())
        if (user != part && user->getBlock() == whole.getParentBlock() &&
            user->getName() == part->getName() && user->getOperands() == part->getOperands() &&
            user->getAttrs() == part->getAttrs() &&
            user->getPropertiesAsAttribute() == part->getPropertiesAsAttribute())
          same = user;
      if (same) {
        replaced[part->getResult(0)] = same->getResult(0);
        part->getResult(0).replaceAllUsesWith(same->getResult(0));
        part->erase();
      } else if (mlir::Operation *definition = whole.getDefiningOp()) {
        part->moveAfter(definition);
      } else {
        part->moveBefore(&whole.getParentBlock()->front());
      }
    }
  }
  // The result of a trace comes first in its block; it may have been moved down.
  for (ir::SuspendOp suspend : suspendsOf(function))
    for (mlir::Operation &op : *suspend.getResume())
      if (llvm::isa<ir::TraceResultOp, ir::TraceReturnedOp, ir::CallReturnedOp>(op)) {
        op.moveBefore(&suspend.getResume()->front());
        break;
      }
}

} // namespace rtsl::continuation
