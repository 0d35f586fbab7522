//===- CutJoins.h - states for code that many states reach ----------------===//
#pragma once

#include "codegen/passes/continuation/common/TracedFunctions.h"

namespace rtsl::continuation {

/// Limits for cutting joins.
struct JoinOptions {
  /// Number of copied operations, over all states, that is always accepted.
  std::size_t free = 4000;
  /// Also accepted: this factor times the operations of the function.
  std::size_t copies = 4;
  /// Least number of operations between two cuts.
  std::size_t shortest = 16;

  static JoinOptions forCpp() { return {1500, 4, 32}; }
};

/// Makes a state of its own of code that would be copied to many states. Runs after
/// insertSuspends() and endAtTailTraces().
void cutJoins(FuncOp function, const JoinOptions &options = {});

} // namespace rtsl::continuation
