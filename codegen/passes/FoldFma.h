//===- FoldFma.h - math.fma of constants ----------------------------------===//
#pragma once

namespace mlir {
class RewritePatternSet;
}

namespace rtsl::codegen {

/// Adds a pattern that folds math.fma of constants, scalars and vectors, which MLIR does not.
void addFmaFolding(mlir::RewritePatternSet &patterns);

} // namespace rtsl::codegen
