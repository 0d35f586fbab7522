//===- ExpandCopies.h - small copies as loads and stores ------------------===//
//
// An `rtsl.copy` or `rtsl.clear` of an aggregate with at most 64 leaves (scalars, vectors,
// references) becomes loads and stores of the leaves, which the optimiser can analyse. Larger ones,
// and buffers, become memcpy and memset later.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <memory>

namespace mlir {
class Pass;
} // namespace mlir

namespace rtsl::codegen {

/// `rtsl-expand-copies`, on a function.
std::unique_ptr<mlir::Pass> createExpandCopiesPass();

} // namespace rtsl::codegen
