//===- RayGraph.h - which rays send which ---------------------------------===//
//
// Rays of one kind run the same methods: those that return a color are one kind, those with each
// type of payload another. `generate` is a kind of its own. The kinds of rays that the methods of a
// kind may send bound the stack (runtime/device/engines/StackBound.h).
//
//===----------------------------------------------------------------------===//
#pragma once

#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "mlir/IR/BuiltinOps.h"

#include <cstdint>
#include <string>
#include <vector>

namespace rtsl {

struct RayGraph {
  struct Kind {
    std::string name;           // "color", the payload's struct, or "generate"
    std::uint32_t sent = 0;     // bits: kinds of rays that its methods send and wait for
    std::uint32_t sentLast = 0; // bits: kinds of rays that its methods send as tail traces
  };
  std::vector<Kind> kinds; // in the numbering of rtsl_ray_kinds
  bool hasGenerate = false;
  /// Only `generate` waits for rays, or nothing does, and no other method has a frame: one level is
  /// enough.
  bool waitsOnce = false;
  /// Rays only replace each other, until one ends: no state that follows a trace sends one.
  bool replace = false;

  /// The exact number of levels that a sample may need.
  std::uint32_t levels(std::uint32_t maxDepth) const;
  /// Does a larger depth limit need a larger stack?
  bool grows() const;
  /// The names of a set of kinds, given as bits.
  std::vector<std::string> names(std::uint32_t set) const;
};

/// Whether a state belongs to `generate`.
bool isOfGenerate(mlir::func::FuncOp state);

/// The graph of a module whose functions have been split.
RayGraph findRays(mlir::ModuleOp module);

} // namespace rtsl
