//===- Restructure.h - blocks and branches back to structured control flow -===//
//
// Level 2 to level 1, for code that people are to read: `cf` becomes `rtsl.if`, `rtsl.loop` and
// `rtsl.switch`, block arguments become variables under the author's names. Machine code is made
// from level 2 and never comes by here.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "mlir/IR/BuiltinOps.h"

namespace rtsl {

/// Brings a function of level 2, or a state, back to level 1. Fails with a message if a block ends
/// in something other than a branch of `cf`, `func.return` or `rtsl.end`.
mlir::LogicalResult restructure(mlir::func::FuncOp function);

/// The same for every function of the module that has states or branches.
mlir::LogicalResult restructure(mlir::ModuleOp module);

/// `rtsl-restructure`, on a function.
void registerRestructurePass();

} // namespace rtsl
