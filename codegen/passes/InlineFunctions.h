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

namespace mlir {
class Pass;
} // namespace mlir

namespace rtsl::codegen {

/// `rtsl-inline`, on a module of level 2.
std::unique_ptr<mlir::Pass> createInlineFunctionsPass();

} // namespace rtsl::codegen
