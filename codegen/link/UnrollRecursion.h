//===- UnrollRecursion.h - functions that call themselves, level by level -===//
#pragma once

#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "mlir/IR/BuiltinOps.h"

#include <cstdint>

namespace rtsl {

/// Copies of a function that calls itself, on objects that members refer to, at most so many.
constexpr std::uint32_t mostRecursionLevels = 32;

/// Makes each call round a cycle of functions that do not trace one of a copy of its own, a level
/// further down, so that nothing recurses: no chain of references of the scene's objects is longer
/// than `referenceChain`. What would have more levels than mostRecursionLevels stays as it is.
void unrollRecursion(mlir::ModuleOp ir, std::uint32_t referenceChain);

/// A function that does not trace and may call itself; null if there is none.
mlir::func::FuncOp recursiveFunction(mlir::ModuleOp ir);

} // namespace rtsl
