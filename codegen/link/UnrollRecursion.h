//===- UnrollRecursion.h - copies of recursive functions ------------------===//
#pragma once

#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "mlir/IR/BuiltinOps.h"

#include <cstdint>

namespace rtsl {

/// The most copies of a recursive function whose recursion follows references between objects.
constexpr std::uint32_t mostRecursionLevels = 32;

/// Replaces each recursive call of functions that do not trace by a call of a copy, one level
/// further down, so that nothing recurses: no chain of references of the scene's objects is longer
/// than `referenceChain`. Functions that would need more levels than mostRecursionLevels are
/// unchanged.
void unrollRecursion(mlir::ModuleOp ir, std::uint32_t referenceChain);

/// A recursive function that does not trace; null if there is none.
mlir::func::FuncOp recursiveFunction(mlir::ModuleOp ir);

} // namespace rtsl
