//===- CutJoins.cpp - states for code that many states reach --------------===//
//
//   ^resume1: br ^join   ^resume2: br ^join         ^resume1: br ^cut   ^resume2: br ^cut
//   ^join:                                    ==>   ^cut: rtsl.suspend ^join {rtsl.join}
//     rest                                          ^join: rtsl.trace_returned
//                                                     rest
//
// Each state has a copy of the blocks that its beginning reaches before the next trace. If traces
// are in consecutive branches, the first state has copies of all the following code, the second of
// one branch less, and so on: code size grows with the square of the program. If the copies would
// be much larger than the program itself, some joins become the beginnings of states: the values
// live there go through the frame, and a jump leads from state to state. No ray is sent.
//
// Joins in loops are used only if others do not suffice.
//
//===----------------------------------------------------------------------===//
#include "codegen/passes/continuation/suspend/CutJoins.h"
#include "codegen/ir/Attributes.h"

#include "mlir/Analysis/CFGLoopInfo.h"
#include "mlir/IR/Dominance.h"
#include "mlir/IR/RegionGraphTraits.h"
#include "llvm/ADT/PostOrderIterator.h"
#include "llvm/ADT/SmallPtrSet.h"

#include <algorithm>
#include <vector>

namespace rtsl::continuation {

namespace {

class JoinCutter {
public:
  JoinCutter(FuncOp function, const JoinOptions &options);
  void run();

private:
  using Cuts = llvm::SmallPtrSet<mlir::Block *, 16>;
  std::size_t copiedOperations(const Cuts &cuts, std::size_t limit);
  void findShared();
  Cuts choose(std::size_t distance, bool inLoops);
  void cut(mlir::Block *join);

  FuncOp function;
  JoinOptions options;
  std::vector<mlir::Block *> order; // reverse postorder
  llvm::DenseMap<mlir::Block *, std::size_t> sizes;
  llvm::SmallPtrSet<mlir::Block *, 32> shared; // reached from several beginnings of states
  llvm::SmallPtrSet<mlir::Block *, 32> looped;
  std::size_t size = 0;
};

bool suspends(mlir::Block *block) {
  return llvm::isa<ir::SuspendOp>(block->back());
}

JoinCutter::JoinCutter(FuncOp function, const JoinOptions &options)
    : function(function), options(options) {
  llvm::ReversePostOrderTraversal<mlir::Block *> traversal(&function.getBody().front());
  order.assign(traversal.begin(), traversal.end());
  for (mlir::Block *block : order) {
    sizes[block] = block->getOperations().size();
    size += sizes[block];
  }
}

/// The sum over all states; the count stops when it exceeds `limit`.
std::size_t JoinCutter::copiedOperations(const Cuts &cuts, std::size_t limit) {
  std::size_t copied = 0;
  llvm::SmallVector<mlir::Block *> beginnings = {order.front()};
  for (mlir::Block *block : order)
    if (suspends(block))
      beginnings.push_back(block->getSuccessor(0));
    else if (cuts.contains(block))
      beginnings.push_back(block);
  for (mlir::Block *beginning : beginnings) {
    llvm::SmallPtrSet<mlir::Block *, 32> seen;
    llvm::SmallVector<mlir::Block *> pending = {beginning};
    seen.insert(beginning);
    while (!pending.empty() && copied <= limit) {
      mlir::Block *block = pending.pop_back_val();
      copied += sizes.lookup(block);
      if (suspends(block))
        continue;
      for (mlir::Block *next : block->getSuccessors())
        if (!cuts.contains(next) && seen.insert(next).second)
          pending.push_back(next);
    }
    if (copied > limit)
      break;
  }
  return copied;
}

/// Finds shared blocks: propagates the one beginning that reaches each block until a second one
/// does.
void JoinCutter::findShared() {
  llvm::DenseMap<mlir::Block *, mlir::Block *> reachedFrom;
  llvm::SmallVector<mlir::Block *> pending;
  const auto reach = [&](mlir::Block *block, mlir::Block *beginning) {
    mlir::Block *&known = reachedFrom[block];
    if (known == beginning || shared.contains(block))
      return;
    if (!known && beginning)
      known = beginning;
    else
      shared.insert(block);
    pending.push_back(block);
  };
  mlir::DominanceInfo dominance(function);
  const mlir::CFGLoopInfo loops(dominance.getDomTree(&function.getBody()));
  for (mlir::Block *block : order)
    if (loops.getLoopDepth(block) != 0)
      looped.insert(block);
  reach(order.front(), order.front());
  for (mlir::Block *block : order)
    if (suspends(block))
      reach(block->getSuccessor(0), block->getSuccessor(0));
  while (!pending.empty()) {
    mlir::Block *block = pending.pop_back_val();
    if (suspends(block))
      continue;
    for (mlir::Block *next : block->getSuccessors())
      reach(next, shared.contains(block) ? nullptr : reachedFrom.lookup(block));
  }
}

/// Chooses joins with at least `distance` operations between two of them.
JoinCutter::Cuts JoinCutter::choose(std::size_t distance, bool inLoops) {
  Cuts cuts;
  std::size_t since = 0;
  for (mlir::Block *block : order) {
    if (!shared.contains(block))
      continue;
    const bool isJoin = !block->hasNoPredecessors() && !block->getSinglePredecessor();
    if (isJoin && since >= distance && (inLoops || !looped.contains(block))) {
      cuts.insert(block);
      since = 0;
    }
    since += sizes.lookup(block);
  }
  return cuts;
}

void JoinCutter::cut(mlir::Block *join) {
  mlir::Block *before = new mlir::Block;
  join->getParent()->getBlocks().insert(join->getIterator(), before);
  for (mlir::BlockArgument argument : join->getArguments())
    argument.replaceAllUsesWith(before->addArgument(argument.getType(), argument.getLoc()));
  join->replaceAllUsesWith(before); // for its predecessors
  join->eraseArguments(0, join->getNumArguments());

  const mlir::Location location = join->front().getLoc();
  mlir::OpBuilder builder = mlir::OpBuilder::atBlockBegin(join);
  ir::TraceReturnedOp::create(builder, location);
  builder.setInsertionPointToEnd(before);
  auto jump = ir::SuspendOp::create(builder, location, mlir::Value(), mlir::Value(),
                                    mlir::ValueRange{}, builder.getArrayAttr({}), join);
  ir::attr::join.set(jump);
}

void JoinCutter::run() {
  const std::size_t limit = options.copies * size + options.free;
  if (copiedOperations({}, limit) <= limit)
    return;
  findShared();
  Cuts best;
  for (bool inLoops : {false, true}) {
    std::size_t bestCopied = ~std::size_t(0);
    for (std::size_t distance = size / 2; distance != 0 && distance >= options.shortest;
         distance /= 2) {
      const Cuts cuts = choose(distance, inLoops);
      const std::size_t copied = copiedOperations(cuts, std::min(bestCopied, 64 * limit));
      if (copied < bestCopied) {
        best = cuts;
        bestCopied = copied;
      }
      if (copied <= limit)
        break;
    }
    if (bestCopied <= limit)
      break;
  }
  for (mlir::Block *block : order)
    if (best.contains(block))
      cut(block);
}

} // namespace

void cutJoins(FuncOp function, const JoinOptions &options) {
  if (!suspendsOf(function).empty())
    JoinCutter(function, options).run();
}

} // namespace rtsl::continuation
