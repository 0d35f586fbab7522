//===- ResultVariables.h - variables that hold the result of a call -------===//
//
// An aggregate that a function returns is in a variable of its caller, zero before the call:
//
//     %layers = rtsl.var "layers" : !rtsl.ptr<!rtsl.struct<...>>
//     call @Principled.layers(%self, %layers)
//     %body = rtsl.load (rtsl.field %layers["body"])
//
//===----------------------------------------------------------------------===//
#pragma once

#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "mlir/IR/Dominance.h"

namespace rtsl::codegen {

/// Is it a variable that is zero before the call, that only the call writes, and that is read
/// only after it?
bool isResult(mlir::Value variable, mlir::func::CallOp call, const mlir::DominanceInfo &dominance);

} // namespace rtsl::codegen
