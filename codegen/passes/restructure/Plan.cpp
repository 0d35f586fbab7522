//===- Plan.cpp - the position of each block ------------------------------===//
//
// The code of a block is nested in that of its immediate dominator: at the branch to it, if there
// is only one, or after everything that the dominator branches to, if several edges lead to it
// (Ramsey, "Beyond Relooper", ICFP 2022). A block to which a loop exits follows the loop.
//
//===----------------------------------------------------------------------===//
#include "codegen/passes/restructure/Steps.h"

#include "mlir/Analysis/CFGLoopInfo.h"
#include "llvm/ADT/MapVector.h"
#include "llvm/ADT/PostOrderIterator.h"

namespace rtsl::restructuring {

using mlir::Block;

namespace {

/// The main exit of a loop: preferably the one in its header, as in a `while`; then the one in its
/// latch, as in a `do`; then the target of most exits, and the first of these in the text.
Block *mainExit(mlir::CFGLoop &loop) {
  Block *header = loop.getHeader();
  auto exitFrom = [&](Block *block) -> Block * {
    for (Block *next : block->getSuccessors())
      if (!loop.contains(next))
        return next;
    return nullptr;
  };
  if (Block *exit = exitFrom(header))
    return exit;
  Block *latch = loop.getLoopLatch();
  if (Block *exit = latch ? exitFrom(latch) : nullptr)
    return exit;
  llvm::MapVector<Block *, unsigned> edges;
  for (Block *block : loop.getBlocks())
    for (Block *next : block->getSuccessors())
      if (!loop.contains(next))
        ++edges[next];
  Block *best = nullptr;
  for (auto [block, count] : edges)
    if (!best || count > edges.lookup(best))
      best = block;
  return best;
}

} // namespace

Plan::Plan(FuncOp function) {
  mlir::Region &body = function.getBody();
  if (body.hasOneBlock())
    return;
  mlir::DominanceInfo dominance(function);
  mlir::CFGLoopInfo loops(dominance.getDomTree(&body));
  llvm::SmallVector<Block *> order;
  for (Block *block : llvm::ReversePostOrderTraversal<Block *>(&body.front()))
    order.push_back(block);

  // Without back edges; several cases of a switch with one target are one edge.
  auto edgesInto = [&](Block *block) {
    llvm::SmallPtrSet<Block *, 4> edges;
    for (Block *from : block->getPredecessors())
      if (!dominance.dominates(block, from))
        edges.insert(from);
    return edges.size();
  };

  llvm::DenseMap<Block *, Block *> after; // the header of the loop that the block follows
  for (Block *header : order) {
    mlir::CFGLoop *loop = loops.getLoopFor(header);
    if (!loop || loop->getHeader() != header)
      continue;
    Exit exit;
    exit.target = mainExit(*loop);
    mlir::CFGLoop *around = loop->getParentLoop();
    exit.followsLoop = exit.target && dominance.properlyDominates(header, exit.target) &&
                       edgesInto(exit.target) == 1 && (!around || around->contains(exit.target));
    if (exit.followsLoop)
      after[exit.target] = header;
    exits[header] = exit;
  }

  for (Block *block : llvm::drop_begin(order)) {
    Block *dominator = dominance.getNode(block)->getIDom()->getBlock();
    if (Block *header = after.lookup(block)) {
      parent[block] = parent.lookup(header); // processed before, because it dominates
      continue;
    }
    parent[block] = dominator;
    if (edgesInto(block) == 1) {
      inlined.insert(block);
      continue;
    }
    // Exits of a loop join after it.
    Block *left = nullptr;
    for (mlir::CFGLoop *loop = loops.getLoopFor(dominator); loop && !loop->contains(block);
         loop = loop->getParentLoop())
      left = loop->getHeader();
    if (left)
      parent[block] = parent.lookup(left);
    (left ? mergesAfterLoop[left] : merges[dominator]).push_back(block);
  }
}

llvm::ArrayRef<Block *> Plan::following(Block *block) const {
  auto found = merges.find(block);
  return found == merges.end() ? llvm::ArrayRef<Block *>() : llvm::ArrayRef(found->second);
}

llvm::ArrayRef<Block *> Plan::followingLoop(Block *header) const {
  auto found = mergesAfterLoop.find(header);
  if (found == mergesAfterLoop.end())
    return {};
  return found->second;
}

bool Plan::isVisible(Block *definition, Block *use) const {
  for (; use; use = parent.lookup(use))
    if (use == definition)
      return true;
  return false;
}

} // namespace rtsl::restructuring
