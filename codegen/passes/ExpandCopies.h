//===- ExpandCopies.h - small copies, value by value -------------------===//
//
// An `rtsl.copy` or `rtsl.clear` of an aggregate with at most 64 leaves (scalars, vectors,
// references) becomes loads and stores of the leaves, which the optimiser sees through. Larger
// ones, and buffers, stay for memcpy and memset.
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
