//===- KeptState.h - the state that a waiting ray keeps -------------------===//
//
// The machine has one state, that of the current ray (runtime/device/engines/Machine.h). The parts
// that states read after a trace, before writing them, must be kept while the ray waits: they are
// found here by liveness of state variables over all states of a program, including the reads of
// the runtime. The same parts are kept at all traces.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "mlir/IR/BuiltinOps.h"

#include <cstdint>

namespace rtsl {

struct KeptState {
  std::uint64_t fields = 0;     // bits: KeptField of runtime/device/engines/KeptState.h
  std::uint32_t attributes = 0; // bits: words of RtslState::attributes

  /// Words in memory, for this number of color components.
  std::uint32_t words(std::uint32_t colorComponents) const;
};

/// Finds it for a module whose functions have been split but not numbered yet.
KeptState findKeptState(mlir::ModuleOp module);

/// Components of the colors of a module; 3 if it uses no color.
std::uint32_t colorComponentsOf(mlir::ModuleOp module);

} // namespace rtsl
