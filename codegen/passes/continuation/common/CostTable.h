//===- CostTable.h - the cost of saving and of recomputing ----------------===//
//
// In the units of language/Costs.h.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "mlir/IR/Operation.h"

#include <cstdint>

namespace rtsl::continuation {

/// The cost of executing `op` again.
std::int64_t recomputeCost(mlir::Operation *op);

/// How much more often a block in `depth` loops runs than one in none.
std::int64_t loopFrequency(unsigned depth);

/// The cost of keeping a value of this type across a trace that runs `traceFrequency` times, when it
/// is made `madeFrequency` times: stored when made, loaded when the trace comes back.
std::int64_t saveCost(mlir::Type type, std::int64_t madeFrequency, std::int64_t traceFrequency);

} // namespace rtsl::continuation
