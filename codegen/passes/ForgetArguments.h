//===- ForgetArguments.h - arguments that no callee uses ------------------===//
//
//   func.func private @Tiles.over(%uv, %uv_dx) {       the same
//     ... only %uv ...
//   }
//   %dx = rtsl.load (rtsl.state "dUVdx")
//   func.call @Tiles.over(%uv, %dx)              ==>   func.call @Tiles.over(%uv, %zero)
//
// What is only computed for such arguments is removed. Above all this finds which state is read: a
// program whose images have one level reads no footprints, though lookups are called with them.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <memory>

namespace mlir {
class Pass;
} // namespace mlir

namespace rtsl::codegen {

/// `rtsl-forget-arguments`, on a module of level 2.
std::unique_ptr<mlir::Pass> createForgetArgumentsPass();

} // namespace rtsl::codegen
