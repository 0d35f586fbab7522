//===- MinimumCut.h - what to save and what to recompute ------------------===//
//
// The decision at one trace, without IR. There is a graph of values: some are needed behind the
// trace, and some can be recomputed from others, their operands. A needed value is either saved, at
// its cost, or recomputed, at another cost, and then its operands are needed in turn. Wanted is the
// cheapest choice.
//
// It is a minimum cut. Each value v is two nodes, N(v), "v is needed", and R(v), "v is recomputed":
//
//   source --inf--> N(v)                v is needed behind the trace
//   N(v) --save cost--> R(v)            cut: v is saved
//   R(v) --recompute cost--> sink       cut: v is recomputed (infinite if it cannot be)
//   R(v) --inf--> N(u)                  for each operand u of v
//
// A choice is a cut of the same cost and the other way round, so the minimum cut is the optimum,
// sharing of operands included. Among several the one with the smallest source side is taken: it is
// unique, whatever the order in which flow was found, and recomputes least.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "llvm/ADT/SmallVector.h"

#include <cstdint>
#include <vector>

namespace rtsl::continuation {

constexpr std::int64_t impossible = std::int64_t(1) << 60;

struct ValueNode {
  std::int64_t saveCost = impossible;      // below `impossible` if it can be saved
  std::int64_t recomputeCost = impossible; // below `impossible` if it can be recomputed
  llvm::SmallVector<unsigned, 4> operands; // smaller indices: a graph without circles
  bool needed = false;                     // behind the trace
};

struct Choice {
  std::vector<bool> saved, recomputed; // a value that is not needed is neither
  std::int64_t cost = 0;
  bool feasible = false; // false: a needed value can be neither saved nor recomputed
};

/// The cheapest choice. Costs are not negative; their sum stays below `impossible`.
Choice chooseSaved(const std::vector<ValueNode> &values);

} // namespace rtsl::continuation
