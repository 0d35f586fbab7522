//===- KnownConditions.h - what expressions that are kept whole come to -----===//
//
// The IR cannot fold `rtsl.expression`, whose meaning is the author's tree. Where the tree's leaves
// are known, its value is: `i < 3` in the first round of a loop, `scale < 0.2` in a function that
// was called with 0.5.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/lower/SourceTable.h"

#include "mlir/IR/Value.h"

namespace rtsl {

/// Whether a bool is true, as far as that is known.
std::optional<bool> knownCondition(mlir::Value condition, const SourceTable &table);

} // namespace rtsl
