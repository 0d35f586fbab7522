//===- CutJoins.h - states of their own for code that many states reach ---===//
#pragma once

#include "codegen/passes/continuation/common/TracedFunctions.h"

namespace rtsl::continuation {

/// When joins are cut.
struct JoinOptions {
  /// Copies of operations, over all states, that are always fine.
  std::size_t free = 4000;
  /// And so many times the operations of the function.
  std::size_t copies = 4;
  /// Operations between two cuts, at least.
  std::size_t shortest = 16;

  static JoinOptions forPeople() { return {1500, 4, 32}; }
};

/// Gives code that many states would have copies of a state of its own. After insertSuspends() and
/// endAtLastTraces().
void cutJoins(FuncOp function, const JoinOptions &options = {});

} // namespace rtsl::continuation
