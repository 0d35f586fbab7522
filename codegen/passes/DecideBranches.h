//===- DecideBranches.h - branches whose way is known -----------------------===//
//
//   cf.cond_br %first, ^a, ^b                    cf.cond_br %first, ^a, ^b
// ^b:                                 ==>      ^b:
//   cf.cond_br %first, ^c, ^d                    cf.cond_br %false, ^c, ^d
//
// Behind a branch its condition is known. What else is known, a caller may say who knows more than
// the IR does.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "mlir/Dialect/Func/IR/FuncOps.h"

#include <functional>
#include <optional>

namespace rtsl::codegen {

/// Whether a condition is true, as far as that is known.
using KnownCondition = std::function<std::optional<bool>(mlir::Value)>;

/// Makes conditions of branches constants where they are known; Simplify folds such branches.
/// Returns whether there were any.
bool decideBranches(mlir::func::FuncOp function, const KnownCondition &isKnown);

} // namespace rtsl::codegen
