//===- KeptState.h - what of a waiting ray's state is kept ----------------===//
//
// The machine has one state, that of the ray whose turn it is (runtime/device/engines/Machine.h).
// What states that run behind a trace read of it before they write it has to be kept while the ray
// waits: found here by liveness of state variables over all states of a program, with what the
// runtime reads on behalf of an operation. One set serves all traces.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "mlir/IR/BuiltinOps.h"

#include <cstdint>

namespace rtsl {

struct KeptState {
  std::uint64_t fields = 0;     // bits: KeptField of runtime/device/engines/KeptState.h
  std::uint32_t attributes = 0; // bits: words of RtslState::attributes

  /// Words in memory, with colors of so many components.
  std::uint32_t words(std::uint32_t colorComponents) const;
};

/// Of a module whose functions have been split and not been numbered yet.
KeptState findKeptState(mlir::ModuleOp module);

/// Components of the colors of a module; 3 if it has no color.
std::uint32_t colorComponentsOf(mlir::ModuleOp module);

} // namespace rtsl
