//===- HoistVariables.h - variables to the entry of their function --------===//
//
// Moves every `rtsl.var` to the entry block, as promotion and stack slots require. A variable is
// zero each time that control reaches it, so an `rtsl.clear` remains where it was (promotion makes
// a value of that). Such variables come from loop bodies and inlined functions.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "mlir/Dialect/Func/IR/FuncOps.h"

#include <memory>

namespace mlir {
class Pass;
} // namespace mlir

namespace rtsl::codegen {

void hoistVariables(mlir::func::FuncOp function);

/// `rtsl-hoist-vars`, on a function of level 2.
std::unique_ptr<mlir::Pass> createHoistVariablesPass();

} // namespace rtsl::codegen
