//===- Operands.h - arguments of calls, compared and computed again -------===//
//
// Two methods call one function with the same member of their object, which each loads. Such
// arguments are equal, and may be computed where another call stands: they consist of operations
// without effects and of members, which are constant while rays are traced.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "mlir/IR/Builders.h"

namespace rtsl::codegen {

/// Are the values equal?
bool isSame(mlir::Value a, mlir::Value b);

/// Can the value be computed from known ones?
bool canCompute(mlir::Value value, llvm::function_ref<bool(mlir::Value)> isKnown);

/// Computes a value, for which canCompute holds; `known` gives a known value where the builder is,
/// null for others.
mlir::Value compute(mlir::OpBuilder &builder, mlir::Value value,
                    llvm::function_ref<mlir::Value(mlir::Value)> known);

} // namespace rtsl::codegen
