//===- CostTable.h - costs of saving and recomputing ----------------------===//
//
// All costs of splitting. A unit is one scalar instruction.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "mlir/IR/Operation.h"

#include <cstdint>

namespace rtsl::continuation {

// Each ray has its own frame: on a GPU a word of it is a load from or a store to the second-level
// cache at best. A chain of a few arithmetic operations is cheaper than fetching its result.
constexpr std::int64_t loadWordCost = 8;
constexpr std::int64_t storeWordCost = 4;
constexpr std::int64_t frameWordCost = 4; // a larger frame leaves room for fewer rays
constexpr std::int64_t boolCost = 6;      // one bit of a word, which must be extracted

/// Units for executing `op` once more. Constants and addresses are free; state variables and
/// members cost a load that likely hits the cache; buffers are expensive.
std::int64_t recomputeCost(mlir::Operation *op);

/// Estimated executions of a block in `depth` loops for each execution outside of loops.
std::int64_t loopFrequency(unsigned depth);

/// Units for saving a value of this type across a trace that runs `traceFrequency` times, if it is
/// defined `madeFrequency` times: stored when defined, loaded after the trace.
std::int64_t saveCost(mlir::Type type, std::int64_t madeFrequency, std::int64_t traceFrequency);

} // namespace rtsl::continuation
