//===- ShareExpressions.h - what is computed twice is computed once -------===//
//
// Common subexpressions over the tree of dominators, as mlir::eliminateCommonSubExpressions finds
// them: pure operations wherever the first one dominates, reads within a block if nothing is
// written in between. MLIR's looks for such a write from the first read on at each read that equals
// it, which takes the square of the time in a long block; this counts writes as it goes.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <memory>

namespace mlir {
class DominanceInfo;
class Operation;
class Pass;
} // namespace mlir

namespace rtsl::codegen {

/// In a function over blocks. True if something was found.
bool shareExpressions(mlir::Operation *function, mlir::DominanceInfo &dominance);

/// The same as a pass, on a module of such functions.
std::unique_ptr<mlir::Pass> createShareExpressionsPass();

} // namespace rtsl::codegen
