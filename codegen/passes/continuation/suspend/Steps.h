//===- Steps.h - blocks end at their traces -------------------------------===//
//
// Each step lies in the file that is named here; Split.cpp calls them.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/passes/continuation/common/Recompute.h"

#include <string>
#include <vector>

namespace rtsl::continuation {

/// What ends a chain of rays but the limit of depth.
struct Endings {
  bool alwaysTraces = false;   // on every way: nothing does
  std::vector<std::string> by; // what conditions are made of: "rand()", "its payload", "rt_Depth"
};

/// Endings.cpp: of a function that traces, before it is split.
Endings endingsOf(FuncOp function);

/// InsertSuspends.cpp: ends blocks at their traces.
void insertSuspends(FuncOp function);
/// Where the summary is known already: it takes a walk over the module.
void insertSuspends(FuncOp function, const WriteSummary &summary);

/// LastTraces.cpp: a method ends at a trace behind which nothing happens; its ray takes the place
/// of this one. Gives where these traces stood.
llvm::SmallVector<mlir::Location> endAtLastTraces(FuncOp function);

/// LastTraces.cpp: whether nothing happens behind a trace but sums and products of what it brings
/// back.
bool onlyScalesAndAdds(ir::SuspendOp suspend);

} // namespace rtsl::continuation
