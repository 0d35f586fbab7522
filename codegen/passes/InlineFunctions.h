//===- InlineFunctions.h - inlining ---------------------------------------===//
//
// Inlines functions, callees first: functions that trace (separately they would need a frame of
// their own), small ones, and those that are called once. It never inlines a function with
// `rtsl.noinline`, or a constructor into another function: members are constants outside of
// constructors. On each cycle of calls (dispatch may be on one) one function is not inlined.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <memory>

#include "mlir/Dialect/Func/IR/FuncOps.h"

namespace mlir {
class Pass;
} // namespace mlir

namespace rtsl::codegen {

/// For a function that traces: is its own frame cheaper than a copy for each caller?
bool isLargeToInline(mlir::func::FuncOp function);

/// `rtsl-inline`, on a module of level 2. With `inlinesAll`, regardless of the size of a function.
std::unique_ptr<mlir::Pass> createInlineFunctionsPass(bool inlinesAll = false);

} // namespace rtsl::codegen
