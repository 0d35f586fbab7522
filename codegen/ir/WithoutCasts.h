//===- WithoutCasts.h - a reference as it was before its casts ------------===//
#pragma once

#include "codegen/ir/dialect/RtslOps.h"

namespace rtsl::ir {

/// The reference whose class was changed by casts, any number of them, to make this one.
inline mlir::Value withoutCasts(mlir::Value reference) {
  while (auto cast = reference.getDefiningOp<CastRefOp>())
    reference = cast.getObject();
  return reference;
}

} // namespace rtsl::ir
