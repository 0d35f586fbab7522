//===- Simplify.h - folding in states -------------------------------------===//
#pragma once

#include "codegen/passes/continuation/Steps.h"

#include "mlir/Rewrite/FrozenRewritePatternSet.h"

namespace rtsl::continuation {

/// Folds, canonicalises and finds common subexpressions in functions over `cf`. It does what the
/// passes of that name do, but takes away blocks that cannot be reached at once: MLIR 22's patterns
/// on branches crash on loops that nobody enters, which is what is left of a loop where a cut has
/// made its condition constant.
class Simplify {
public:
  explicit Simplify(mlir::MLIRContext *context);
  void run(FuncOp function);

private:
  mlir::FrozenRewritePatternSet patterns;
};

} // namespace rtsl::continuation
