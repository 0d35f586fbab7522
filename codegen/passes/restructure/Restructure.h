//===- Restructure.h - blocks and branches to structured control flow -----===//
//
// Level 2 to level 1, for C++ output: `cf` becomes `rtsl.if`, `rtsl.loop` and `rtsl.switch`, block
// arguments become variables with the names in the source. Machine code is generated from level 2,
// without this pass.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "mlir/IR/BuiltinOps.h"

namespace rtsl {

/// Restructures a function of level 2, or a state, to level 1. Fails with a message if a block ends
/// in something other than a branch of `cf`, `func.return` or `rtsl.end`.
mlir::LogicalResult restructure(mlir::func::FuncOp function);

/// The same for every function of the module that has states or branches.
mlir::LogicalResult restructure(mlir::ModuleOp module);

/// `rtsl-restructure`, on a function.
void registerRestructurePass();

} // namespace rtsl
