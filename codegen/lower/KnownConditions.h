//===- KnownConditions.h - the values of expressions that are kept whole --===//
//
// The IR cannot fold `rtsl.expression`, whose meaning is an expression tree of the source. If the
// values of the tree's leaves are known, so is its own: `i < 3` in the first iteration of a loop,
// `scale < 0.2` in a function that was called with 0.5.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/lower/SourceTable.h"

#include "mlir/IR/Value.h"

namespace rtsl {

/// The value of a bool, if it is known.
std::optional<bool> knownCondition(mlir::Value condition, const SourceTable &table);

} // namespace rtsl
