//===- Rays.h - operations that send rays ---------------------------------===//
#pragma once

#include "codegen/ir/dialect/RtslOps.h"

#include "llvm/ADT/StringSwitch.h"

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

/// Does the program read anything of the footprints of rays (RTSL_NEEDS_FOOTPRINT)?
inline bool readsFootprints(mlir::ModuleOp program) {
  const auto isOfFootprint = [](llvm::StringRef state) {
    return llvm::StringSwitch<bool>(state)
#define RTSL_STATE_VARIABLE(name, type, writer, need, ...)                                         \
  .Case(#name, llvm::StringRef(#need) == "FOOTPRINT" || llvm::StringRef(#need) == "NORMAL_"        \
                                                                                  "CHANGES")
#include "language/StateVariables.def"
        .Default(false);
  };
  return anyOperation(program, [&](mlir::Operation *op) {
    if (auto attribute = llvm::dyn_cast<AttributeOp>(op))
      return attribute.getAxis() && !attribute->use_empty();
    auto state = llvm::dyn_cast<StateOp>(op);
    return state && isOfFootprint(state.getName()) &&
           llvm::any_of(state->getUsers(), [](mlir::Operation *user) { // `generate` writes some
             return !llvm::isa<StoreOp>(user);
           });
  });
}

} // namespace rtsl::ir
