//===- MinimumCut.h - the choice between saving and recomputing -----------===//
//
// The decision at one trace, without IR. In a graph of values, some are needed after the trace, and
// some can be recomputed from others, their operands. A needed value is either saved, at its cost,
// or recomputed, at another cost, and then its operands are needed in turn. Find the cheapest
// choice.
//
// It is a minimum cut. Each value v is two nodes, N(v), "v is needed", and R(v), "v is recomputed":
//
//   source --inf--> N(v)                v is needed after the trace
//   N(v) --save cost--> R(v)            cut: v is saved
//   R(v) --recompute cost--> sink       cut: v is recomputed (infinite if it cannot be)
//   R(v) --inf--> N(u)                  for each operand u of v
//
// Choices and cuts correspond one to one, with equal costs, so the minimum cut is the optimum,
// including shared operands. Among several minimum cuts, the one with the smallest source side is
// chosen: it is unique, regardless of the order in which flow was found, and recomputes least.
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
  llvm::SmallVector<unsigned, 4> operands; // with smaller indices: the graph is acyclic
  bool needed = false;                     // after the trace
};

struct Choice {
  std::vector<bool> saved, recomputed; // a value that is not needed is neither
  std::int64_t cost = 0;
  bool feasible = false; // false: a needed value can be neither saved nor recomputed
};

/// The cheapest choice. Costs are not negative; their sum stays below `impossible`.
Choice chooseSaved(const std::vector<ValueNode> &values);

} // namespace rtsl::continuation
