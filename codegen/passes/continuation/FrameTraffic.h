//===- FrameTraffic.h - loads and stores of the frame ---------------------===//
#pragma once

#include "codegen/passes/continuation/Report.h"
#include "codegen/passes/continuation/common/TracedFunctions.h"

#include "llvm/ADT/StringMap.h"

namespace rtsl::continuation {

/// The current loads and stores of a function's states, by the state that the trace resumes.
class FrameTraffic {
public:
  void add(FuncOp state);
  /// Stores before the trace that resumes `state`, and loads after it.
  TraceTraffic at(llvm::StringRef state) const;

private:
  llvm::StringMap<TraceTraffic> traffic;
};

} // namespace rtsl::continuation
