//===- FrameTraffic.cpp - loads and stores of the frame -------------------===//
#include "codegen/passes/continuation/FrameTraffic.h"

#include "codegen/ir/Layout.h"

#include <algorithm>
#include <set>

namespace rtsl::continuation {

namespace {

/// Bytes of the values that the block's operations of this kind load or store; a word of bools
/// counts once.
template <typename Op>
std::uint32_t bytesIn(mlir::Block &block) {
  std::uint32_t bytes = 0;
  std::set<std::uint32_t> wordsOfBools;
  for (Op op : block.getOps<Op>()) {
    if (op.getBit()) {
      bytes += wordsOfBools.insert(op.getOffset()).second ? 4 : 0;
      continue;
    }
    if constexpr (std::is_same_v<Op, ir::FrameLoadOp>)
      bytes += ir::sizeInBytes(op.getResult().getType());
    else
      bytes += ir::sizeInBytes(op.getValue().getType());
  }
  return bytes;
}

/// The least and most bytes loaded on a path through the state. Loops contain no loads, so both are
/// known after as many iterations as there are blocks.
BytesRange loadedOnPaths(FuncOp state) {
  llvm::DenseMap<mlir::Block *, BytesRange> upTo;
  BytesRange paths = {~0u, 0};
  bool changed = true;
  for (std::size_t round = 0; changed && round <= state.getBody().getBlocks().size(); ++round) {
    changed = false;
    for (mlir::Block &block : state.getBody()) {
      const std::uint32_t own = bytesIn<ir::FrameLoadOp>(block);
      BytesRange range = {~0u, 0};
      for (mlir::Block *predecessor : block.getPredecessors())
        if (auto before = upTo.find(predecessor); before != upTo.end())
          range = {std::min(range.least, before->second.least),
                   std::max(range.most, before->second.most)};
      if (block.isEntryBlock())
        range.least = 0;
      else if (range.least == ~0u)
        continue; // no predecessor is known yet
      range = {range.least + own, range.most + own};
      auto [at, isNew] = upTo.try_emplace(&block, range);
      changed |= isNew || at->second.least != range.least || at->second.most != range.most;
      at->second = range;
    }
  }
  for (auto &[block, range] : upTo)
    if (block->hasNoSuccessors())
      paths = {std::min(paths.least, range.least), std::max(paths.most, range.most)};
  return paths.least == ~0u ? BytesRange{0, 0} : paths;
}

} // namespace

void FrameTraffic::add(FuncOp state) {
  TraceTraffic &after = traffic[state.getSymName()];
  after.restored = loadedOnPaths(state);
  state.walk([&](ir::FrameLoadOp) { ++after.loads; });

  const auto storesBefore = [&](mlir::Operation *suspends, llvm::StringRef resume) {
    mlir::Block &block = *suspends->getBlock();
    const std::uint32_t bytes = bytesIn<ir::FrameStoreOp>(block);
    const auto stores = llvm::range_size(block.getOps<ir::FrameStoreOp>());
    TraceTraffic &at = traffic[resume];
    at.stored = at.isStored
                    ? BytesRange{std::min(at.stored.least, bytes), std::max(at.stored.most, bytes)}
                    : BytesRange{bytes, bytes};
    at.stores = std::max(at.stores, static_cast<unsigned>(stores));
    at.isStored = true;
  };
  state.walk([&](mlir::Operation *op) {
    if (auto next = llvm::dyn_cast<ir::NextOp>(op); next && next.getState())
      storesBefore(op, *next.getState());
    else if (auto call = llvm::dyn_cast<ir::EnterOp>(op); call && call.getResume())
      storesBefore(op, *call.getResume());
  });
}

TraceTraffic FrameTraffic::at(llvm::StringRef state) const {
  return traffic.lookup(state);
}

} // namespace rtsl::continuation
