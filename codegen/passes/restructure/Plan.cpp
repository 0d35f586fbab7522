//===- Plan.cpp - where each block goes -----------------------------------===//
//
// The code of a block stands in that of its immediate dominator: where the branch to it was, if
// there is only one, or behind everything that the dominator branches to, if several ways meet in
// it (Ramsey, "Beyond Relooper", ICFP 2022). A block at which a loop is left stands behind the
// loop.
//
//===----------------------------------------------------------------------===//
#include "codegen/passes/restructure/Steps.h"

#include "mlir/Analysis/CFGLoopInfo.h"
#include "llvm/ADT/MapVector.h"
#include "llvm/ADT/PostOrderIterator.h"

namespace rtsl::restructuring {

using mlir::Block;

namespace {

/// Where control goes when it leaves the loop: best where its head says so, as in a `while`; then
/// where its end does, as in a `do`; then what is left for most often, first in the text.
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
  llvm::MapVector<Block *, unsigned> ways;
  for (Block *block : loop.getBlocks())
    for (Block *next : block->getSuccessors())
      if (!loop.contains(next))
        ++ways[next];
  Block *best = nullptr;
  for (auto [block, count] : ways)
    if (!best || count > ways.lookup(best))
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

  // Not those that go back to a loop's header; several cases of a switch are one way.
  auto waysInto = [&](Block *block) {
    llvm::SmallPtrSet<Block *, 4> ways;
    for (Block *from : block->getPredecessors())
      if (!dominance.dominates(block, from))
        ways.insert(from);
    return ways.size();
  };

  llvm::DenseMap<Block *, Block *> behind; // the header of the loop that the block stands behind
  for (Block *header : order) {
    mlir::CFGLoop *loop = loops.getLoopFor(header);
    if (!loop || loop->getHeader() != header)
      continue;
    Exit exit;
    exit.target = mainExit(*loop);
    mlir::CFGLoop *around = loop->getParentLoop();
    exit.standsBehindLoop = exit.target && dominance.properlyDominates(header, exit.target) &&
                            waysInto(exit.target) == 1 &&
                            (!around || around->contains(exit.target));
    if (exit.standsBehindLoop)
      behind[exit.target] = header;
    exits[header] = exit;
  }

  for (Block *block : llvm::drop_begin(order)) {
    Block *dominator = dominance.getNode(block)->getIDom()->getBlock();
    if (Block *header = behind.lookup(block)) {
      parent[block] = parent.lookup(header); // comes before, for it dominates
      continue;
    }
    parent[block] = dominator;
    if (waysInto(block) == 1) {
      inlined.insert(block);
      continue;
    }
    // Ways out of a loop meet behind it.
    Block *left = nullptr;
    for (mlir::CFGLoop *loop = loops.getLoopFor(dominator); loop && !loop->contains(block);
         loop = loop->getParentLoop())
      left = loop->getHeader();
    if (left)
      parent[block] = parent.lookup(left);
    (left ? mergesBehindLoop[left] : merges[dominator]).push_back(block);
  }
}

llvm::ArrayRef<Block *> Plan::following(Block *block) const {
  auto found = merges.find(block);
  return found == merges.end() ? llvm::ArrayRef<Block *>() : llvm::ArrayRef(found->second);
}

llvm::ArrayRef<Block *> Plan::followingLoop(Block *header) const {
  auto found = mergesBehindLoop.find(header);
  if (found == mergesBehindLoop.end())
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
