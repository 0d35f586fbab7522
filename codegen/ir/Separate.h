//===- Separate.h - functions that stay functions -------------------------===//
//
// A switch that chooses between a few functions becomes one function with them, which is faster.
// With hundreds it would become a function so large that passes take longer than in proportion to
// its size.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/ir/Attributes.h"

#include "mlir/Dialect/Func/IR/FuncOps.h"

namespace rtsl::ir {

/// A switch that chooses between more functions leaves them separate.
constexpr std::size_t mostJoinedFunctions = 32;

inline void keepSeparateIfMany(llvm::ArrayRef<mlir::func::FuncOp> choices) {
  if (choices.size() <= mostJoinedFunctions)
    return;
  for (mlir::func::FuncOp function : choices)
    attr::separate.set(function);
}

} // namespace rtsl::ir
