//===- CostTable.h - costs of saving and recomputing ----------------------===//
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

/// Estimated executions of a block in `depth` loops for each execution outside of loops.
std::int64_t loopFrequency(unsigned depth);

/// The cost of saving a value of this type across a trace that runs `traceFrequency` times, if it
/// is defined `madeFrequency` times: stored when defined, loaded after the trace.
std::int64_t saveCost(mlir::Type type, std::int64_t madeFrequency, std::int64_t traceFrequency);

} // namespace rtsl::continuation
