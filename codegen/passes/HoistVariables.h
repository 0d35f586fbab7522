//===- HoistVariables.h - variables to the entry of their function -----===//
//
// Moves every `rtsl.var` to the entry block, where promotion and stack slots want it. A variable is
// zero each time that control comes to it, so an `rtsl.clear` stays behind in its place (promotion
// makes a value of that). Loop bodies and inlined functions are where such variables come from.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <memory>

namespace mlir {
class Pass;
} // namespace mlir

namespace rtsl::codegen {

/// `rtsl-hoist-vars`, on a function of level 2.
std::unique_ptr<mlir::Pass> createHoistVariablesPass();

} // namespace rtsl::codegen
