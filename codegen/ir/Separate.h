//===- Separate.h - functions that stay functions -------------------------===//
//
// A switch that chooses between a few functions becomes one function with them, which is faster.
// With hundreds it would become a function so large that passes take longer than in proportion to
// its size.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "mlir/Dialect/Func/IR/FuncOps.h"

namespace rtsl::ir {

/// On functions that are not inlined, neither here nor by LLVM.
constexpr llvm::StringLiteral separateFunction = "rtsl.separate";

/// A switch that chooses between more functions leaves them separate.
constexpr std::size_t mostJoinedFunctions = 32;

inline void keepSeparateIfMany(llvm::ArrayRef<mlir::func::FuncOp> choices) {
  if (choices.size() <= mostJoinedFunctions)
    return;
  for (mlir::func::FuncOp function : choices)
    function->setAttr(separateFunction, mlir::UnitAttr::get(function.getContext()));
}

} // namespace rtsl::ir
