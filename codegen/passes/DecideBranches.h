//===- DecideBranches.h - branches on known conditions --------------------===//
//
//   cf.cond_br %first, ^a, ^b                    cf.cond_br %first, ^a, ^b
// ^b:                                 ==>      ^b:
//   cf.cond_br %first, ^c, ^d                    cf.cond_br %false, ^c, ^d
//
// After a branch, the value of its condition is known. The caller may supply other known conditions
// that do not follow from the IR.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "mlir/Dialect/Func/IR/FuncOps.h"

#include <functional>
#include <optional>

namespace rtsl::codegen {

/// The value of a condition, if it is known.
using KnownCondition = std::function<std::optional<bool>(mlir::Value)>;

/// Replaces known conditions of branches by constants; Simplify folds such branches. Returns
/// whether there were any.
bool decideBranches(mlir::func::FuncOp function, const KnownCondition &isKnown);

} // namespace rtsl::codegen
