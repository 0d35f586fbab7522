//===- Report.h - costs and savings of splitting --------------------------===//
//
// Recorded by the steps of splitting; codegen/explain makes text, JSON and drawings of it.
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

/// The location of a trace in the source.
using TracePlace = ir::SourcePlace;

/// Over all paths to a trace, or all paths from it.
struct BytesRange {
  std::uint32_t least = 0, most = 0;
};

/// Loads and stores of the frame at one trace.
struct TraceTraffic {
  BytesRange stored, restored;    // before and after it
  unsigned stores = 0, loads = 0; // operations
  bool isStored = false;          // by some state
};

/// The same after the steps up to this one.
struct StepReport {
  const char *step;             // "liveness": none of the optimisations
  std::uint32_t savedBytes = 0; // in the frame while the ray is traced
  TraceTraffic traffic;
};

/// What runs at a trace in addition to the code of the source.
struct ExtraReport {
  unsigned recomputed = 0, stores = 0, loads = 0; // operations, except constants and addresses
  std::int64_t cost = 0;                          // units of CostTable.h
};

/// A value that is live across a trace.
struct LiveValue {
  std::string name;
  bool isConstant = false; // one without a name in the source
};

/// One trace of a function, in the order of the code.
struct TraceReport {
  TracePlace place;
  std::string callee;    // of a call on a frame of its own; empty: it is a trace
  std::string resumesAt; // the state
  // The values that plain liveness would save, constants included. This and the data derived from
  // it (`steps`, `rematerialised`, `plainly`) require SplitOptions::explain.
  std::vector<LiveValue> live;
  std::uint32_t liveBytes = 0;
  std::vector<LiveValue> saved;
  std::vector<std::string> savedShown;   // their names in messages
  std::vector<std::uint32_t> savedSizes; // bytes of each; 0 for a bool
  std::uint32_t savedBytes = 0;          // bools as bits of one word
  std::vector<LiveValue> rematerialised; // of the live values; without intermediate ones
  std::uint32_t rematerialisedBytes = 0; // of these, had they been saved
  std::vector<StepReport> steps;         // in the order of the optimisations
  ExtraReport extra, plainly;            // with the optimisations, and with all live values saved
  /// No ray is sent: this state begins at a join that several states reach (CutJoins.h).
  bool isJoin = false;
  /// Followed only by sums and products of the result: recursion saves their operands.
  bool onlyScalesAndAdds = false;
};

/// A transition at the end of a state.
struct TransitionReport {
  /// Call: runs `callee`, then state `to`.
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
  std::vector<TracePlace> tailTraces; // whose rays replace this one
  continuation::FrameLayout frame;
  std::vector<std::string> states;
  std::vector<TransitionReport> transitions; // in the order of `states`, without duplicates
};

struct SplitReport {
  std::vector<FunctionReport> functions;
  RayGraph rays;
  std::vector<std::uint32_t> frameAreas; // frameAreas() of calls/Steps.h
  std::uint32_t keptWords = 0;           // of the state of a waiting ray (KeptState.h)
  std::vector<continuation::TrimmedPayload> trimmed;
  /// The depth limit for which the stack size is given; that of scenes without one of their own.
  std::uint32_t maxDepth = 8;
  /// States of all functions.
  std::uint32_t stateCount() const;
  /// Bytes of the largest frame, with those of its callees above it.
  std::uint32_t frameSize() const;
  /// Additional bytes for each object in a chain of references; 0 if no function calls itself.
  std::uint32_t frameGrowth() const;
  /// Bytes of stack for each ray, with a frame of that size.
  std::uint64_t levelBytes() const;
};

} // namespace rtsl
