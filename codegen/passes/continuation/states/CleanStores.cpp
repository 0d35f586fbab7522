//===- CleanStores.cpp - do not store what the slot already holds ---------===//
//
//   %i = rtsl.frame_load "i"[0]
//   ...                                 the store is removed, and the load if it has no other use
//   rtsl.frame_store %i, "i"[0]   ==>
//
// Stores are only at the ends of states, so between a load and a store of a state no other
// operation writes the slot, unless it shares words with an object; only the value has to be
// followed, through arguments of blocks.
//
//===----------------------------------------------------------------------===//
#include "codegen/ir/Attributes.h"
#include "codegen/ir/IncomingEdges.h"
#include "codegen/passes/continuation/states/Steps.h"

#include "mlir/IR/PatternMatch.h"
#include "mlir/Transforms/RegionUtils.h"
#include "llvm/ADT/DenseSet.h"

namespace rtsl::continuation {

namespace {

class SlotContents {
public:
  explicit SlotContents(ir::FrameStoreOp store) : store(store) {}

  bool isHeldAlready() {
    return !ir::attr::shared.isOn(store) && holdsBefore(store, store.getValue());
  }

private:
  /// Does the slot hold `value` just before `op`, on every path?
  bool holdsBefore(mlir::Operation *op, mlir::Value value);
  bool overlaps(std::uint32_t offset, mlir::Type type, std::optional<std::uint32_t> bit);
  /// Is it the slot of the store? The name must match too: in C++ output, slots that share words
  /// are separate fields.
  template <typename Op>
  bool isSame(Op op) {
    return op.getOffset() == store.getOffset() && op.getBit() == store.getBit() &&
           op.getName() == store.getName();
  }

  ir::FrameStoreOp store;
  // Pending queries: assumed true in a cycle, where the answer is that at the entry of the loop.
  llvm::DenseSet<std::pair<mlir::Block *, mlir::Value>> pending;
};

bool SlotContents::overlaps(std::uint32_t offset, mlir::Type type,
                            std::optional<std::uint32_t> bit) {
  auto words = [](mlir::Type type) -> std::uint32_t {
    auto vector = llvm::dyn_cast<mlir::VectorType>(type);
    return vector ? 4 * vector.getNumElements() : 4;
  };
  if (bit && store.getBit() && offset == store.getOffset())
    return *bit == *store.getBit();
  return offset < store.getOffset() + words(store.getValue().getType()) &&
         store.getOffset() < offset + words(type);
}

bool SlotContents::holdsBefore(mlir::Operation *op, mlir::Value value) {
  mlir::Block *block = op->getBlock();
  for (mlir::Operation *at = op->getPrevNode(); at; at = at->getPrevNode()) {
    if (auto load = llvm::dyn_cast<ir::FrameLoadOp>(at)) {
      if (load.getResult() == value)
        return isSame(load);
    } else if (auto earlier = llvm::dyn_cast<ir::FrameStoreOp>(at)) {
      if (overlaps(earlier.getOffset(), earlier.getValue().getType(), earlier.getBit()))
        return earlier.getValue() == value && isSame(earlier);
    }
  }
  if (value.getParentBlock() == block && !llvm::isa<mlir::BlockArgument>(value))
    return false; // computed here
  if (block->isEntryBlock() || block->hasNoPredecessors())
    return false;
  if (!pending.insert({block, value}).second)
    return true;
  auto argument = llvm::dyn_cast<mlir::BlockArgument>(value);
  bool merges = argument && argument.getOwner() == block;
  bool holds = true;
  ir::forEachEdgeInto(*block, [&](ir::Edge edge) {
    const mlir::Value incoming = merges ? edge.passedTo(argument) : value;
    holds = holds && incoming && holdsBefore(edge.terminator, incoming);
  });
  return holds;
}

} // namespace

void cleanStores(FuncOp state) {
  if (state.isExternal())
    return;
  llvm::SmallVector<ir::FrameStoreOp> stores;
  state.walk([&](ir::FrameStoreOp store) { stores.push_back(store); });
  llvm::SmallVector<ir::FrameStoreOp> redundant;
  for (ir::FrameStoreOp store : stores)
    if (SlotContents(store).isHeldAlready())
      redundant.push_back(store);
  for (ir::FrameStoreOp store : redundant)
    store.erase();
  mlir::IRRewriter rewriter(state.getContext());
  (void)mlir::runRegionDCE(rewriter, state->getRegions()); // what computed them
}

} // namespace rtsl::continuation
