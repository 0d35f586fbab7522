//===- Rays.h - operations that send rays ---------------------------------===//
#pragma once

#include "codegen/ir/dialect/RtslOps.h"

namespace rtsl::ir {

/// A call of `trace`: shaders run for its ray before the next operation.
inline bool isTrace(mlir::Operation *op) {
  return llvm::isa<TraceOp, TracePayloadOp>(op);
}

/// A trace, or an operation that sends shadow rays to lights.
inline bool sendsRays(mlir::Operation *op) {
  return isTrace(op) || llvm::isa<IlluminanceOp, IlluminateOp>(op);
}

/// Does `holds` hold for `in` or an operation in it?
inline bool anyOperation(mlir::Operation *in, llvm::function_ref<bool(mlir::Operation *)> holds) {
  return in
      ->walk([&](mlir::Operation *op) {
        return holds(op) ? mlir::WalkResult::interrupt() : mlir::WalkResult::advance();
      })
      .wasInterrupted();
}

} // namespace rtsl::ir
