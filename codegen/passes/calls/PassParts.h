//===- PassParts.h - parts of aggregates as arguments ---------------------===//
//
//   func.func private @Coated.mirrored(%point) {       func.func private @Coated.mirrored(%shine) {
//     %shine = rtsl.load (rtsl.field %point["shine"])
//     ...                                         ==>    ...
//   call @Coated.mirrored(%point)                      %s = rtsl.load (rtsl.field %point["shine"])
//                                                      call @Coated.mirrored(%s)
//
// An aggregate that is only passed so need not be in memory, and equal calls can be told.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "mlir/Dialect/Func/IR/FuncOps.h"

namespace rtsl::codegen {

struct FunctionEffects;

/// Passes the parts of aggregates that a function of level 2 only reads; `callers` are its calls.
void passParts(mlir::func::FuncOp function, llvm::ArrayRef<mlir::func::CallOp> callers,
               const FunctionEffects &effects);

} // namespace rtsl::codegen
