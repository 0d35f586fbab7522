//===- Simplify.h - folding over `cf` -------------------------------------===//
//
// Folds, canonicalises and eliminates common subexpressions in functions of level 2. It does the
// same as MLIR's passes of these names, but erases unreachable blocks at once: the branch patterns
// of MLIR 22 crash or do not terminate on unreachable loops, which remain of a loop whose condition
// turns out to be constant.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "mlir/Rewrite/FrozenRewritePatternSet.h"

#include <memory>

namespace mlir {
class Pass;
} // namespace mlir

namespace rtsl::codegen {

/// Owns the patterns, which are built once.
class Simplify {
public:
  explicit Simplify(mlir::MLIRContext *context);
  void run(mlir::func::FuncOp function) const;

private:
  mlir::FrozenRewritePatternSet patterns;
};

/// `rtsl-simplify`, on a function.
std::unique_ptr<mlir::Pass> createSimplifyPass();

} // namespace rtsl::codegen
