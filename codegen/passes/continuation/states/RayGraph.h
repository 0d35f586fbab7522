//===- RayGraph.h - which rays send which ---------------------------------===//
//
// A kind of rays are those that the same programs answer: the ones that bring a color, and one kind
// for each type of payload. `generate` is a kind of its own. What the programs of a kind may send
// bounds the stack (runtime/device/engines/StackBound.h).
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
    std::uint32_t sent = 0;     // bits: kinds of rays that its programs wait for
    std::uint32_t sentLast = 0; // and that take the place of one of this kind
  };
  std::vector<Kind> kinds; // as rtsl_ray_kinds numbers them
  bool hasGenerate = false;
  /// No ray waits but `generate`, or none does, and no other method has a frame: one level serves
  /// all.
  bool waitsOnce = false;

  /// Levels that any sample needs at most, exactly.
  std::uint32_t levels(std::uint32_t maxDepth) const;
  /// Does a larger limit of depth need a larger stack?
  bool grows() const;
  /// Of a set of kinds, given as bits.
  std::vector<std::string> names(std::uint32_t set) const;
};

/// Whether a state is one of `generate`.
bool isOfGenerate(mlir::func::FuncOp state);

/// The graph of a module whose functions have been split.
RayGraph findRays(mlir::ModuleOp module);

} // namespace rtsl
