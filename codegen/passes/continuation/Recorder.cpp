//===- Recorder.cpp - records the splitting of a function -----------------===//
#include "codegen/passes/continuation/Recorder.h"

#include "codegen/ir/Attributes.h"
#include "codegen/ir/Layout.h"
#include "codegen/passes/continuation/common/CostTable.h"
#include "codegen/passes/continuation/suspend/CutJoins.h"
#include "language/Costs.h"

#include "llvm/ADT/StringSet.h"

#include <algorithm>

namespace rtsl::continuation {

namespace {

/// Bytes of values in a frame: 32 bools take a word.
std::uint32_t bytesOf(llvm::ArrayRef<mlir::Value> values) {
  std::uint32_t bools = 0, bytes = 0;
  for (mlir::Value value : values) {
    if (value.getType().isInteger(1))
      ++bools;
    else
      bytes += ir::sizeInBytes(value.getType());
  }
  return bytes + (bools + 31) / 32 * 4;
}

/// The traffic if every value that a trace saves is stored before it and restored after it.
StepReport stepBeforeSplit(const char *step, const SuspendPlan &plan) {
  const std::uint32_t bytes = bytesOf(plan.saved);
  const auto count = static_cast<unsigned>(plan.saved.size());
  return {step, bytes, {{bytes, bytes}, {bytes, bytes}, count, count, true}};
}

/// Units of CostTable.h.
std::int64_t costOf(const TraceTraffic &traffic) {
  return traffic.stored.most / 4 * cost::frameStore + traffic.restored.most / 4 * cost::frameLoad;
}

} // namespace

Recorder::Recorder(FuncOp function, const WriteSummary &summary, bool explains,
                   FunctionReport &report)
    : function(function), summary(summary), explains(explains), report(report) {
  report.name = function.getSymName().str();
  report.endings = endingsOf(function);
}

void Recorder::foundTailTraces(llvm::ArrayRef<mlir::Location> places) {
  for (mlir::Location place : places)
    report.tailTraces.push_back(ir::placeOf(place));
}

mlir::LogicalResult Recorder::suspended() {
  for (ir::SuspendOp suspend : suspendsOf(function)) {
    TraceReport trace;
    trace.place = ir::placeOf(suspend.getLoc());
    trace.isJoin = ir::attr::join.isOn(suspend);
    trace.onlyScalesAndAdds = !trace.isJoin && onlyScalesAndAdds(suspend);
    if (auto call = llvm::dyn_cast_or_null<ir::EnterOp>(suspend->getPrevNode()))
      trace.callee = call.getCallee().str();
    trace.resumesAt = report.name + ".state" + std::to_string(report.traces.size() + 1);
    report.traces.push_back(std::move(trace));
  }
  return notePlainLiveness("liveness");
}

mlir::LogicalResult Recorder::trimmedVectors() {
  return notePlainLiveness("trim-vectors");
}

static LiveValue describe(mlir::Value value, UniqueNames &names) {
  mlir::Operation *op = value.getDefiningOp();
  const bool isConstant = op && op->hasTrait<mlir::OpTrait::ConstantLike>();
  return {names.of(value), isConstant && authorsName(value).empty()};
}

/// The values that would be saved if none were recomputed: after the first step, the baseline of
/// all others.
mlir::LogicalResult Recorder::notePlainLiveness(const char *step) {
  if (!explains)
    return mlir::success();
  RematerialiseOptions plain;
  plain.onlyAddresses = true;
  auto plans = planContinuations(function, plain, summary);
  if (mlir::failed(plans))
    return mlir::failure();
  for (auto [plan, trace] : llvm::zip(*plans, report.traces)) {
    trace.steps.push_back(stepBeforeSplit(step, plan));
    if (trace.steps.size() > 1)
      continue;
    for (mlir::Value value : plan.saved)
      trace.live.push_back(describe(value, plainNames));
    trace.liveBytes = trace.steps.front().savedBytes;
  }
  return mlir::success();
}

void Recorder::planned(llvm::ArrayRef<SuspendPlan> plans) {
  UniqueNames names;
  for (auto [plan, trace] : llvm::zip(plans, report.traces)) {
    trace.savedBytes = bytesOf(plan.saved);
    for (mlir::Value value : plan.saved) {
      trace.saved.push_back(describe(value, names));
      trace.savedShown.push_back(describeToAuthor(value));
      trace.savedSizes.push_back(value.getType().isInteger(1) ? 0
                                                              : ir::sizeInBytes(value.getType()));
    }
    if (explains)
      explainPlan(plan, trace);
  }
}

/// Records which of the values that plain liveness would save are recomputed, and at what cost.
void Recorder::explainPlan(const SuspendPlan &plan, TraceReport &trace) {
  trace.steps.push_back(stepBeforeSplit("rematerialise", plan));
  llvm::StringSet<> live;
  for (const LiveValue &value : trace.live)
    live.insert(value.name);
  llvm::SmallVector<mlir::Value> again;
  llvm::SmallPtrSet<mlir::Operation *, 16> operations;
  for (mlir::Value value : plan.recomputed) {
    mlir::Operation *op = value.getDefiningOp();
    if (const std::int64_t cost = recomputeCost(op); operations.insert(op).second && cost != 0) {
      ++trace.extra.recomputed;
      trace.extra.cost += cost;
    }
    if (live.contains(plainNames.of(value))) {
      trace.rematerialised.push_back(describe(value, plainNames));
      again.push_back(value);
    }
  }
  trace.rematerialisedBytes = bytesOf(again);
}

void Recorder::laidOut(FrameLayout frame) {
  report.frame = std::move(frame);
}

void Recorder::split(llvm::ArrayRef<FuncOp> states) {
  for (FuncOp state : states)
    report.states.push_back(state.getSymName().str());
}

void Recorder::cleanedStores(FuncOp state) {
  if (explains)
    afterCleanStores.add(state);
}

static void noteTransitions(FuncOp state, std::vector<TransitionReport> &transitions) {
  llvm::StringSet<> called; // calls: the jumps to their states are not listed
  state.walk([&](ir::EnterOp call) {
    called.insert((call.getCallee() + ".state0").str());
    const TransitionReport transition = {TransitionReport::Call, state.getSymName().str(),
                                         call.getResume().value_or("").str(),
                                         call.getCallee().str()};
    if (std::find(transitions.begin(), transitions.end(), transition) == transitions.end())
      transitions.push_back(transition);
  });
  static constexpr std::pair<ir::Transition, TransitionReport::Kind> kinds[] = {
      {ir::Transition::Return, TransitionReport::Return},
      {ir::Transition::Trace, TransitionReport::Trace},
      {ir::Transition::Jump, TransitionReport::Jump},
      {ir::Transition::Last, TransitionReport::Last},
      {ir::Transition::Done, TransitionReport::Done}};
  for (const auto &[transition, kind] : kinds) {
    llvm::StringSet<> seen;
    state.walk([&, transition = transition, kind = kind](ir::NextOp next) {
      if (next.getTransition() != transition)
        return;
      const std::string to = next.getState().value_or("").str();
      if (kind == TransitionReport::Jump && called.contains(to))
        return;
      if (seen.insert(to).second)
        transitions.push_back({kind, state.getSymName().str(), to, ""});
    });
  }
}

void Recorder::finished(llvm::ArrayRef<FuncOp> states, bool wereCleaned) {
  for (FuncOp state : states)
    noteTransitions(state, report.transitions);
  if (!explains)
    return;
  FrameTraffic now;
  for (FuncOp state : states)
    now.add(state);
  if (wereCleaned)
    noteTraffic("clean-stores", afterCleanStores);
  noteTraffic(wereCleaned ? "sink-loads" : "split-states", now);
  sumUpExtras();
}

void Recorder::noteTraffic(const char *step, const FrameTraffic &traffic) {
  for (TraceReport &trace : report.traces)
    trace.steps.push_back({step, trace.savedBytes, traffic.at(trace.resumesAt)});
}

void Recorder::sumUpExtras() {
  for (TraceReport &trace : report.traces) {
    const TraceTraffic &plain = trace.steps.front().traffic, &now = trace.steps.back().traffic;
    trace.plainly = {0, plain.stores, plain.loads, costOf(plain)};
    trace.extra.stores = now.stores;
    trace.extra.loads = now.loads;
    trace.extra.cost += costOf(now);
  }
}

} // namespace rtsl::continuation
