//===- ShareExpressions.h - common subexpression elimination --------------===//
//
// Common subexpressions over the dominator tree, as in mlir::eliminateCommonSubExpressions: pure
// operations wherever the first one dominates, reads within a block without a write in between. For
// each read, MLIR searches for such a write from the first equal read on, which takes quadratic
// time in a long block; this pass counts writes as it goes.
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

/// Runs on a function over blocks. True if it changed anything.
bool shareExpressions(mlir::Operation *function, mlir::DominanceInfo &dominance);

/// The same as a pass, on a module of such functions.
std::unique_ptr<mlir::Pass> createShareExpressionsPass();

} // namespace rtsl::codegen
