//===- InlineFunctions.h - calls replaced by what they call ------------===//
//
// Inlines, from the leaves of the call graph up: functions that trace (a function of its own would
// need a frame of its own), small ones, and those that are called once. Never one with
// `rtsl.noinline`, a recursive one (dispatch may be), or a constructor into what is none: members
// are constants outside of constructors.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <memory>

#include "mlir/Dialect/Func/IR/FuncOps.h"

namespace mlir {
class Pass;
} // namespace mlir

namespace rtsl::codegen {

/// Of a function that traces: is a frame of its own cheaper than a copy for each of its callers?
bool isLargeToInline(mlir::func::FuncOp function);

/// `rtsl-inline`, on a module of level 2. With `inlinesAll`: whatever the size of a function.
std::unique_ptr<mlir::Pass> createInlineFunctionsPass(bool inlinesAll = false);

} // namespace rtsl::codegen
