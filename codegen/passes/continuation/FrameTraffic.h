//===- FrameTraffic.h - what states move between registers and frame ------===//
#pragma once

#include "codegen/passes/continuation/Report.h"
#include "codegen/passes/continuation/common/TracedFunctions.h"

#include "llvm/ADT/StringMap.h"

namespace rtsl::continuation {

/// The loads and stores of a function's states at one moment, by the state in which they come back.
class FrameTraffic {
public:
  void add(FuncOp state);
  /// What is stored before the trace that comes back in `state`, and restored behind it.
  TraceTraffic at(llvm::StringRef state) const;

private:
  llvm::StringMap<TraceTraffic> traffic;
};

} // namespace rtsl::continuation
