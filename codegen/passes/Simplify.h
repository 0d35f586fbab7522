//===- Simplify.h - folding over `cf` -------------------------------------===//
//
// Folds, canonicalises and finds common subexpressions in functions of level 2. It does what MLIR's
// passes of that name do, but takes away blocks that cannot be reached at once: the patterns on
// branches of MLIR 22 crash or run for ever on loops that nobody enters, which is what is left of a
// loop where a condition turns out to be constant.
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

/// Holds the patterns, which are made once.
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
