//===- Steps.h - blocks end at their traces -------------------------------===//
//
// Steps with options or results, and their files; common/Steps.def has the others. Split.cpp calls
// them.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/passes/continuation/common/Recompute.h"

#include <string>
#include <vector>

namespace rtsl::continuation {

/// What can end a chain of rays other than the depth limit.
struct Endings {
  bool alwaysTraces = false;   // on every path: nothing else does
  std::vector<std::string> by; // sources of conditions: "rand()", "its payload", "rt_Depth"
};

/// Endings.cpp: for a function that traces, before it is split.
Endings endingsOf(FuncOp function);

/// InsertSuspends.cpp: ends blocks at their traces.
void insertSuspends(FuncOp function);
/// The same with a given summary, which takes a walk over the module to compute.
void insertSuspends(FuncOp function, const WriteSummary &summary);

/// TailTraces.cpp: ends a method at a trace that nothing follows; its ray replaces this one.
/// Returns the locations of these traces.
llvm::SmallVector<mlir::Location> endAtTailTraces(FuncOp function);

/// TailTraces.cpp: whether a trace is followed only by sums and products of its result.
bool onlyScalesAndAdds(ir::SuspendOp suspend);

} // namespace rtsl::continuation
