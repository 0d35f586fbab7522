//===- Report.h - what splitting cost and saved ---------------------------===//
//
// What the steps note; codegen/explain makes text, JSON and pictures of it.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/ir/SourcePlace.h"
#include "codegen/passes/continuation/frame/Steps.h"
#include "codegen/passes/continuation/save/Steps.h"
#include "codegen/passes/continuation/states/RayGraph.h"
#include "codegen/passes/continuation/suspend/Steps.h"

#include <cstdint>
#include <string>
#include <vector>

namespace rtsl {

/// Where a trace stands.
using TracePlace = ir::SourcePlace;

/// Over the ways on which a trace is met, or the ways on from it.
struct BytesRange {
  std::uint32_t least = 0, most = 0;
};

/// What is moved between registers and frame at one trace.
struct TraceTraffic {
  BytesRange stored, restored;    // before it, behind it
  unsigned stores = 0, loads = 0; // operations
  bool isStored = false;          // by some state
};

/// The same with all steps done up to one of them.
struct StepReport {
  const char *step;             // "liveness": none of the optimisations
  std::uint32_t savedBytes = 0; // in the frame while the ray is away
  TraceTraffic traffic;
};

/// What a trace runs beside the author's own code.
struct ExtraReport {
  unsigned recomputed = 0, stores = 0, loads = 0; // operations, but for constants and addresses
  std::int64_t cost = 0;                          // units of CostTable.h
};

/// One trace of a function, in the order in which they stand.
struct TraceReport {
  TracePlace place;
  std::string callee;    // of a call on a frame of its own; empty: it is a trace
  std::string resumesAt; // the state
  // What plain liveness would save, constants included. This and what follows from it (`steps`,
  // `rematerialised`, `plainly`) is there if SplitOptions::explain.
  std::vector<std::string> live;
  std::uint32_t liveBytes = 0;
  std::vector<std::string> saved;
  std::vector<std::string> savedShown;     // what messages call them
  std::vector<std::uint32_t> savedSizes;   // bytes of each; 0 of a bool
  std::uint32_t savedBytes = 0;            // bools as bits of one word
  std::vector<std::string> rematerialised; // of what was live; not what it is made from
  std::uint32_t rematerialisedBytes = 0;   // of these, had they been saved
  std::vector<StepReport> steps;           // in the order of the optimisations
  ExtraReport extra, plainly;              // as it is, and if all that is live were saved
  /// No ray is sent: code that many states reach begins here (CutJoins.h).
  bool isJoin = false;
  /// Nothing follows but sums and products of what came back: recursion keeps what these need.
  bool onlyScalesAndAdds = false;
};

/// A way from the end of a state to what comes next.
struct TransitionReport {
  /// Call: of `callee`, and on in `to` when it has returned.
  enum Kind : std::uint8_t { Trace, Jump, Done, Last, Call, Return } kind;
  std::string from, to; // states; `to` is empty for Done, Last and Return
  std::string callee;

  bool operator==(const TransitionReport &other) const {
    return kind == other.kind && from == other.from && to == other.to && callee == other.callee;
  }
};

struct FunctionReport {
  std::string name;
  std::vector<TraceReport> traces;
  continuation::Endings endings;
  std::vector<TracePlace> lastTraces; // whose ray takes the place of this one
  continuation::FrameLayout frame;
  std::vector<std::string> states;
  std::vector<TransitionReport> transitions; // in the order of `states`, none twice
};

struct SplitReport {
  std::vector<FunctionReport> functions;
  RayGraph rays;
  std::vector<std::uint32_t> frameAreas; // frameAreas() of calls/Steps.h
  std::uint32_t keptWords = 0;           // of the state of a ray that waits (KeptState.h)
  std::vector<continuation::TrimmedPayload> trimmed;
  /// The limit of depth for which the stack is shown; that of scenes that name none.
  std::uint32_t maxDepth = 8;
  /// States of all functions.
  std::uint32_t stateCount() const;
  /// Bytes of the largest frame, with those of what is called above it.
  std::uint32_t frameSize() const;
  /// Bytes more for each object in a chain of references; 0 if no function calls itself.
  std::uint32_t frameGrowth() const;
  /// Bytes that a ray takes on the stack, with a frame of that size.
  std::uint64_t levelBytes() const;
};

} // namespace rtsl
