//===- PropagateConstants.h - what is constant whichever way control comes -===//
//
// Sparse conditional constant propagation (Wegman and Zadeck 1991): values are taken for constant,
// and branches for never taken, until something proves otherwise; so it sees through loops, where
// folding alone does not.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <memory>

namespace mlir {
class Pass;
} // namespace mlir

namespace rtsl::codegen {

/// `rtsl-propagate-constants`, on a function.
std::unique_ptr<mlir::Pass> createPropagateConstantsPass();

} // namespace rtsl::codegen
