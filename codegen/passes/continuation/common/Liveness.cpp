//===- Liveness.cpp - which values are live where -------------------------===//
#include "codegen/passes/continuation/common/Liveness.h"

#include "mlir/IR/RegionGraphTraits.h"
#include "llvm/ADT/PostOrderIterator.h"

namespace rtsl::continuation {

Liveness::Liveness(FuncOp function) {
  llvm::ReversePostOrderTraversal<mlir::Block *> traversal(&function.getBody().front());
  order.assign(traversal.begin(), traversal.end());
  auto number = [&](mlir::Value value) {
    numbers[value] = all.size();
    all.push_back(value);
  };
  for (mlir::Block *block : order) {
    for (mlir::BlockArgument argument : block->getArguments())
      number(argument);
    for (mlir::Operation &op : *block)
      for (mlir::Value result : op.getResults())
        number(result);
  }
  mlir::Value object = objectOf(function); // passed with the ray: never saved
  for (mlir::Block *block : order) {
    BlockSets &sets = blocks[block];
    sets.used = sets.defined = sets.in = none();
    for (mlir::BlockArgument argument : block->getArguments())
      sets.defined.set(numberOf(argument));
    for (mlir::Operation &op : *block) {
      for (mlir::Value operand : op.getOperands())
        if (operand != object && !sets.defined.test(numberOf(operand)))
          sets.used.set(numberOf(operand));
      for (mlir::Value result : op.getResults())
        sets.defined.set(numberOf(result));
    }
  }
}

void Liveness::compute(const HandedOn *handedOn) {
  for (mlir::Block *block : order)
    blocks[block].in = none();
  bool changed = true;
  while (changed) {
    changed = false;
    for (mlir::Block *block : llvm::reverse(order)) {
      BlockSets &sets = blocks[block];
      llvm::BitVector live = none();
      if (auto suspend = llvm::dyn_cast<ir::SuspendOp>(block->back()); suspend && handedOn) {
        if (auto handed = handedOn->find(suspend); handed != handedOn->end())
          live = handed->second;
      } else {
        for (mlir::Block *successor : block->getSuccessors())
          live |= blocks[successor].in;
      }
      live.reset(sets.defined);
      live |= sets.used;
      if (live != sets.in) {
        sets.in = std::move(live);
        changed = true;
      }
    }
  }
}

void Liveness::extend(ir::SuspendOp suspend, const llvm::BitVector &handedOn) {
  llvm::SmallVector<std::pair<mlir::Block *, llvm::BitVector>> worklist = {
      {suspend->getBlock(), handedOn}};
  while (!worklist.empty()) {
    auto [block, added] = worklist.pop_back_val();
    BlockSets &sets = blocks[block];
    added.reset(sets.defined);
    added.reset(sets.in);
    if (added.none())
      continue;
    sets.in |= added;
    for (mlir::Block *predecessor : block->getPredecessors())
      if (blocks.count(predecessor) && !llvm::isa<ir::SuspendOp>(predecessor->back()))
        worklist.push_back({predecessor, added});
  }
}

llvm::SmallVector<mlir::Value> Liveness::valuesOf(const llvm::BitVector &set) const {
  llvm::SmallVector<mlir::Value> values;
  for (unsigned index : set.set_bits())
    values.push_back(all[index]);
  return values;
}

} // namespace rtsl::continuation
