//===- Separate.h - functions that are not inlined ------------------------===//
//
// A switch that chooses between a few functions becomes one function together with them, which is
// faster. With hundreds of functions the result would be so large that the time of passes grows
// faster than its size.
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
