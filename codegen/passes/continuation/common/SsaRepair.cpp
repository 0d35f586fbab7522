//===- SsaRepair.cpp - one value with several definitions -----------------===//
//
// The definitions that reach the beginning of a block are found by iteration over the blocks where
// the value is live; where two meet, the block gets an argument (Cytron et al., "Efficiently
// Computing Static Single Assignment Form and the Control Dependence Graph", 1991, pruned by
// liveness). Arguments that merge a single definition with themselves are removed (Braun et al.,
// "Simple and Efficient Construction of Static Single Assignment Form", 2013).
//
//===----------------------------------------------------------------------===//
#include "codegen/passes/continuation/common/SsaRepair.h"
#include "codegen/ir/IncomingEdges.h"

#include "mlir/IR/RegionGraphTraits.h"
#include "llvm/ADT/PostOrderIterator.h"
#include "llvm/ADT/SmallPtrSet.h"
#include "llvm/ADT/SmallVector.h"

namespace rtsl::continuation {

namespace {

class Repair {
public:
  Repair(mlir::Value value, const Redefinitions &redefinitions, const BlockOrder &blocks)
      : value(value), redefinitions(redefinitions), blocks(blocks), home(value.getParentBlock()) {}

  void run();

private:
  /// The value at the end of a block; null: not known yet.
  mlir::Value atEnd(mlir::Block *block);
  void findLiveBlocks(llvm::ArrayRef<mlir::OpOperand *> uses);
  void findReaching(llvm::ArrayRef<mlir::Block *> order);
  void placeArguments(llvm::ArrayRef<mlir::Block *> order);
  bool dropTrivialArgument(llvm::ArrayRef<mlir::Block *> order);

  mlir::Value value;
  const Redefinitions &redefinitions;
  const BlockOrder &blocks;
  mlir::Block *home;
  llvm::SmallPtrSet<mlir::Block *, 16> liveInto;
  // The value at the beginning of a block: a definition, or the block itself, if it merges several.
  llvm::DenseMap<mlir::Block *, mlir::Value> reaching;
  llvm::SmallPtrSet<mlir::Block *, 16> merges;
  llvm::DenseMap<mlir::Block *, mlir::Value> mergeValues;
};

/// Blocks at whose beginning the value is live.
void Repair::findLiveBlocks(llvm::ArrayRef<mlir::OpOperand *> uses) {
  llvm::SmallVector<mlir::Block *> worklist;
  auto add = [&](mlir::Block *block) {
    if (block != home && !redefinitions.count(block) && liveInto.insert(block).second)
      worklist.push_back(block);
  };
  for (mlir::OpOperand *use : uses)
    add(use->getOwner()->getBlock());
  while (!worklist.empty())
    for (mlir::Block *predecessor : worklist.pop_back_val()->getPredecessors())
      add(predecessor);
}

mlir::Value Repair::atEnd(mlir::Block *block) {
  if (auto redefined = redefinitions.find(block); redefined != redefinitions.end())
    return redefined->second;
  if (block == home)
    return value;
  return reaching.lookup(block);
}

/// Adds an argument to every block where two definitions may meet.
void Repair::findReaching(llvm::ArrayRef<mlir::Block *> order) {
  bool changed = true;
  while (changed) {
    changed = false;
    for (mlir::Block *block : order) {
      if (merges.contains(block))
        continue;
      mlir::Value unique;
      bool several = false;
      for (mlir::Block *predecessor : block->getPredecessors()) {
        mlir::Value incoming = atEnd(predecessor);
        if (!incoming)
          continue;
        several |= unique && unique != incoming;
        unique = incoming;
      }
      if (several) {
        merges.insert(block);
        unique = block->addArgument(value.getType(), value.getLoc());
        mergeValues[block] = unique;
      }
      if (unique && reaching.lookup(block) != unique) {
        reaching[block] = unique;
        changed = true;
      }
    }
  }
}

/// Replaces an argument that gets the same definition, or itself, on every edge by that definition.
bool Repair::dropTrivialArgument(llvm::ArrayRef<mlir::Block *> order) {
  for (mlir::Block *block : order) {
    if (!merges.contains(block))
      continue;
    mlir::Value own = mergeValues[block];
    mlir::Value unique;
    bool several = false;
    for (mlir::Block *predecessor : block->getPredecessors()) {
      mlir::Value incoming = atEnd(predecessor);
      if (incoming == own)
        continue;
      several |= unique && unique != incoming;
      unique = incoming;
    }
    if (several || !unique)
      continue;
    for (auto &entry : reaching)
      if (entry.second == own)
        entry.second = unique;
    merges.erase(block);
    mergeValues.erase(block);
    block->eraseArgument(llvm::cast<mlir::BlockArgument>(own).getArgNumber());
    return true;
  }
  return false;
}

/// Passes the definitions that reach the predecessors to the arguments.
void Repair::placeArguments(llvm::ArrayRef<mlir::Block *> order) {
  for (mlir::Block *block : order) {
    if (merges.contains(block))
      ir::forEachEdgeInto(*block,
                          [&](ir::Edge edge) { edge.operands().append(atEnd(edge.from())); });
  }
}

void Repair::run() {
  llvm::SmallVector<mlir::OpOperand *> uses;
  for (mlir::OpOperand &use : value.getUses())
    uses.push_back(&use);
  findLiveBlocks(uses);

  const llvm::SmallVector<mlir::Block *> order = blocks.sorted(liveInto);
  findReaching(order);
  while (dropTrivialArgument(order))
    ;
  for (mlir::OpOperand *use : uses) {
    mlir::Block *block = use->getOwner()->getBlock();
    if (auto redefined = redefinitions.find(block); redefined != redefinitions.end())
      use->set(redefined->second);
    else if (block != home)
      use->set(reaching.lookup(block));
  }
  placeArguments(order);
}

} // namespace

BlockOrder::BlockOrder(mlir::Region &body) {
  for (mlir::Block *block : llvm::ReversePostOrderTraversal<mlir::Block *>(&body.front()))
    numbers.try_emplace(block, numbers.size());
}

llvm::SmallVector<mlir::Block *>
BlockOrder::sorted(const llvm::SmallPtrSetImpl<mlir::Block *> &blocks) const {
  llvm::SmallVector<std::pair<unsigned, mlir::Block *>> numbered;
  for (mlir::Block *block : blocks)
    if (const auto number = numbers.find(block); number != numbers.end())
      numbered.push_back({number->second, block});
  llvm::sort(numbered, llvm::less_first());
  return llvm::to_vector(llvm::make_second_range(numbered));
}

void repairSsa(mlir::Value value, const Redefinitions &redefinitions, const BlockOrder &order) {
  Repair(value, redefinitions, order).run();
}

} // namespace rtsl::continuation
