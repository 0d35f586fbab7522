//===- MakeReducible.cpp - loops with one entry ---------------------------===//
//
//   for (...) {                       state 1:      ^r: cond_br %v, ^step, ^q
//     if (u) {                                      ^q: Q; br ^step
//       c = trace(...);                             ^step: ...; cond_br %again, ^body, ^exit
//       if (v) continue;      --split-->            ^body: cond_br %u, ^trace, ^q
//     }
//     Q;
//   }
//
// The state that begins after the trace enters the loop of ^q, ^step and ^body at two blocks. The
// blocks before the one that becomes the header are copied: here ^q, which then exists once before
// the loop and once in it. A nested loop may be copied twice, so in the worst case code doubles
// with each level of nesting.
//
//===----------------------------------------------------------------------===//
#include "codegen/ir/IncomingEdges.h"
#include "codegen/passes/Components.h"
#include "codegen/passes/restructure/Steps.h"

#include "mlir/IR/IRMapping.h"
#include "llvm/ADT/PostOrderIterator.h"

#include <limits>

namespace rtsl::restructuring {

using mlir::Block;

namespace {

using BlockSet = Components<Block *>::Part;

BlockSet entriesOf(const BlockSet &loop) {
  BlockSet entries;
  for (Block *block : loop)
    if (block->isEntryBlock() ||
        llvm::any_of(block->getPredecessors(), [&](Block *from) { return !loop.contains(from); }))
      entries.insert(block);
  return entries;
}

/// A loop with several entries, outer loops first; empty if there is none.
BlockSet findIrreducible(const BlockSet &part) {
  const auto successors = [](Block *block, llvm::function_ref<void(Block *)> visit) {
    llvm::for_each(block->getSuccessors(), visit);
  };
  for (const BlockSet &loop : Components<Block *>::of(part, successors)) {
    if (loop.size() == 1 && !llvm::is_contained(loop.front()->getSuccessors(), loop.front()))
      continue; // not a loop
    BlockSet entries = entriesOf(loop);
    if (entries.size() > 1)
      return loop;
    BlockSet inside = loop;
    inside.remove(entries.front());
    if (BlockSet found = findIrreducible(inside); !found.empty())
      return found;
  }
  return {};
}

/// The blocks of the loop that can be reached from outside without passing `header`.
BlockSet before(Block *header, const BlockSet &loop, const BlockSet &entries) {
  BlockSet reached;
  for (Block *entry : entries)
    if (entry != header)
      reached.insert(entry);
  for (unsigned i = 0; i < reached.size(); ++i) {
    Block *block = reached[i];
    for (Block *next : block->getSuccessors())
      if (next != header && loop.contains(next))
        reached.insert(next);
  }
  return reached;
}

/// The cheapest set of blocks to copy.
BlockSet cheapestCopy(const BlockSet &loop) {
  BlockSet entries = entriesOf(loop), best;
  std::size_t lowest = std::numeric_limits<std::size_t>::max();
  for (Block *header : entries) {
    BlockSet copied = before(header, loop, entries);
    std::size_t size = 0;
    for (Block *block : copied)
      size += block->getOperations().size();
    if (size < lowest) {
      lowest = size;
      best = std::move(copied);
    }
  }
  return best;
}

/// Edges into the loop from outside lead to the copies.
void copyIntoLoop(const BlockSet &copied, const BlockSet &loop) {
  mlir::IRMapping mapping;
  mlir::Region *region = loop.front()->getParent();
  llvm::SmallVector<Block *> copies;
  for (Block *block : copied) {
    Block *copy = new Block;
    region->push_back(copy);
    copies.push_back(copy);
    mapping.map(block, copy);
  }
  for (auto [block, copy] : llvm::zip(copied, copies)) {
    mlir::OpBuilder builder = mlir::OpBuilder::atBlockEnd(copy);
    for (mlir::Operation &op : *block)
      builder.clone(op, mapping);
  }
  for (Block *block : copied)
    ir::forEachEdgeInto(*block, [&](ir::Edge edge) {
      if (!loop.contains(edge.from()) && !llvm::is_contained(copies, edge.from()))
        edge.terminator->setSuccessor(mapping.lookup(block), edge.successor);
    });
}

BlockSet blocksOf(FuncOp function) {
  BlockSet blocks;
  for (Block *block : llvm::ReversePostOrderTraversal<Block *>(&function.getBody().front()))
    blocks.insert(block);
  return blocks;
}

} // namespace

void makeReducible(FuncOp function) {
  BlockSet loop = findIrreducible(blocksOf(function));
  if (loop.empty())
    return;
  // Copies of blocks define values twice, so values that are live out of a block become variables.
  leaveSsa(function, [](mlir::Value value, Block *use) {
    return value.getParentBlock() == use || value.getParentBlock()->isEntryBlock();
  });
  for (; !loop.empty(); loop = findIrreducible(blocksOf(function)))
    copyIntoLoop(cheapestCopy(loop), loop);
}

} // namespace rtsl::restructuring
