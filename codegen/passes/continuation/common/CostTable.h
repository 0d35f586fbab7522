//===- CostTable.h - what saving and recomputing cost ---------------------===//
//
// The one place with these numbers. A unit is one scalar instruction.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "mlir/IR/Operation.h"

#include <cstdint>

namespace rtsl::continuation {

// A word of the frame lies in the memory of one ray among many: to a GPU that is a load or store
// from the second level cache at best. A chain of a few arithmetic operations is cheaper than
// fetching what it gives.
constexpr std::int64_t loadWordCost = 8;
constexpr std::int64_t storeWordCost = 4;
constexpr std::int64_t frameWordCost = 4; // what a word more does to all rays: fewer fit
constexpr std::int64_t boolCost = 6;      // one bit of a word, but to be picked out of it

/// Units for executing `op` once more. Constants and addresses are free; state of the ray and
/// members cost a load that likely hits; buffers are dear.
std::int64_t recomputeCost(mlir::Operation *op);

/// How much more often a block in `depth` loops runs than one in none.
std::int64_t loopFrequency(unsigned depth);

/// Units for keeping a value of this type across a trace that runs `traceFrequency` times, when it
/// is made `madeFrequency` times: stored when made, loaded when the trace comes back.
std::int64_t saveCost(mlir::Type type, std::int64_t madeFrequency, std::int64_t traceFrequency);

} // namespace rtsl::continuation
