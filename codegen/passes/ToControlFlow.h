//===- ToControlFlow.h - structured control flow to branches -----------===//
//
// Level 1 to level 2: `rtsl.if`, `rtsl.loop`, `rtsl.switch` and `rtsl.illuminance` become blocks
// and branches of `cf`, `rtsl.return` becomes `func.return`. Code after a jump, which cannot run,
// is erased.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <memory>

namespace mlir {
class Pass;
} // namespace mlir

namespace rtsl::codegen {

/// `rtsl-to-cf`, on a function.
std::unique_ptr<mlir::Pass> createToControlFlowPass();

} // namespace rtsl::codegen
