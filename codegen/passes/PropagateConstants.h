//===- PropagateConstants.h - constants across branches and loops ---------===//
//
// Sparse conditional constant propagation (Wegman and Zadeck 1991): values are assumed constant,
// and branches not taken, until proved otherwise; so it finds constants in loops, where folding
// alone does not.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <memory>

namespace mlir {
class Pass;
} // namespace mlir

namespace rtsl::codegen {

/// `rtsl-propagate-constants`, on a function. With `inLoops`, only if it has a loop.
std::unique_ptr<mlir::Pass> createPropagateConstantsPass(bool inLoops = false);

} // namespace rtsl::codegen
