//===- Split.cpp - shaders that trace become state machines ---------------===//
#include "codegen/passes/continuation/Split.h"
#include "codegen/passes/continuation/calls/Steps.h"
#include "codegen/passes/continuation/states/Steps.h"

#include "codegen/ir/Layout.h"
#include "codegen/passes/Simplify.h"
#include "codegen/passes/continuation/FrameTraffic.h"
#include "codegen/passes/continuation/common/CostTable.h"
#include "codegen/passes/continuation/common/Names.h"
#include "codegen/passes/continuation/common/Recompute.h"
#include "codegen/passes/continuation/states/KeptState.h"
#include "codegen/passes/continuation/suspend/CutJoins.h"

#include "mlir/IR/Verifier.h"
#include "llvm/ADT/StringSet.h"

namespace rtsl {

using namespace continuation;

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

/// With everything that a trace saves stored before it and restored behind it.
StepReport stepBeforeSplit(const char *step, const SuspendPlan &plan) {
  const std::uint32_t bytes = bytesOf(plan.saved);
  const auto count = static_cast<unsigned>(plan.saved.size());
  return {step, bytes, {{bytes, bytes}, {bytes, bytes}, count, count, true}};
}

/// Units of CostTable.h.
std::int64_t costOf(const TraceTraffic &traffic) {
  return traffic.stored.most / 4 * storeWordCost + traffic.restored.most / 4 * loadWordCost;
}

/// Takes one function through all steps.
class FunctionSplitter {
public:
  FunctionSplitter(FuncOp function, const SplitOptions &options, const codegen::Simplify &simplify,
                   const WriteSummary &summary, FunctionReport &report)
      : function(function), options(options), simplify(simplify), summary(summary), report(report) {
  }

  mlir::LogicalResult run();

private:
  mlir::LogicalResult check(llvm::StringRef step);
  void decide(FuncOp function);
  void listTraces();
  mlir::LogicalResult reportPlainLiveness(const char *step);
  mlir::LogicalResult planAndRematerialise();
  mlir::LogicalResult cleanUp(llvm::ArrayRef<FuncOp> states);
  void reportTraffic(const char *step, const FrameTraffic &traffic);
  void sumUpExtras();

  FuncOp function;
  const SplitOptions &options;
  const codegen::Simplify &simplify;
  const WriteSummary &summary;
  FunctionReport &report;
  UniqueNames plainNames;
};

mlir::LogicalResult FunctionSplitter::check(llvm::StringRef step) {
  if (!options.verifyEach || mlir::succeeded(mlir::verify(function)))
    return mlir::success();
  return function.emitError() << "`" << function.getSymName() << "` is broken after the step `"
                              << step << "`";
}

/// A branch that is decided may decide others.
void FunctionSplitter::decide(FuncOp function) {
  while (options.isKnown && codegen::decideBranches(function, options.isKnown))
    simplify.run(function);
}

void FunctionSplitter::listTraces() {
  for (ir::SuspendOp suspend : suspendsOf(function)) {
    TraceReport trace;
    trace.place = ir::placeOf(suspend.getLoc());
    trace.isJoin = suspend->hasAttr(joinMark);
    trace.onlyScalesAndAdds = !trace.isJoin && onlyScalesAndAdds(suspend);
    if (auto call = llvm::dyn_cast_or_null<ir::EnterOp>(suspend->getPrevNode()))
      trace.callee = call.getCallee().str();
    trace.resumesAt = report.name + ".state" + std::to_string(report.traces.size() + 1);
    report.traces.push_back(std::move(trace));
  }
}

/// What would be saved if nothing were computed again: with the first step, the figure that all
/// others are compared with.
mlir::LogicalResult FunctionSplitter::reportPlainLiveness(const char *step) {
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
      trace.live.push_back(plainNames.of(value));
    trace.liveBytes = trace.steps.front().savedBytes;
  }
  return mlir::success();
}

mlir::LogicalResult FunctionSplitter::planAndRematerialise() {
  RematerialiseOptions how;
  how.onlyAddresses = !options.rematerialise;
  auto plans = planContinuations(function, how, summary);
  if (mlir::failed(plans))
    return mlir::failure();
  UniqueNames names;
  for (auto [plan, trace] : llvm::zip(*plans, report.traces)) {
    trace.savedBytes = bytesOf(plan.saved);
    for (mlir::Value value : plan.saved) {
      trace.saved.push_back(names.of(value));
      trace.savedShown.push_back(describeToAuthor(value));
      trace.savedSizes.push_back(value.getType().isInteger(1) ? 0
                                                              : ir::sizeInBytes(value.getType()));
    }
    if (!options.explain)
      continue;
    trace.steps.push_back(stepBeforeSplit("rematerialise", plan));
    llvm::StringSet<> live;
    for (const std::string &name : trace.live)
      live.insert(name);
    llvm::SmallVector<mlir::Value> again;
    llvm::SmallPtrSet<mlir::Operation *, 16> operations;
    for (mlir::Value value : plan.recomputed) {
      mlir::Operation *op = value.getDefiningOp();
      if (const std::int64_t cost = recomputeCost(op); operations.insert(op).second && cost != 0) {
        ++trace.extra.recomputed;
        trace.extra.cost += cost;
      }
      if (std::string name = plainNames.of(value); live.contains(name)) {
        trace.rematerialised.push_back(name);
        again.push_back(value);
      }
    }
    trace.rematerialisedBytes = bytesOf(again);
  }
  rematerialise(function, *plans);
  return mlir::success();
}

mlir::LogicalResult FunctionSplitter::cleanUp(llvm::ArrayRef<FuncOp> states) {
  FrameTraffic cleaned;
  for (FuncOp state : states) {
    function = state;
    cleanStores(state);
    if (options.explain)
      cleaned.add(state);
    sinkLoads(state);
    simplify.run(state);
    decide(state);
    if (mlir::failed(check("clean-up")))
      return mlir::failure();
  }
  if (options.explain)
    reportTraffic("clean-stores", cleaned);
  return mlir::success();
}

void FunctionSplitter::reportTraffic(const char *step, const FrameTraffic &traffic) {
  for (TraceReport &trace : report.traces)
    trace.steps.push_back({step, trace.savedBytes, traffic.at(trace.resumesAt)});
}

void FunctionSplitter::sumUpExtras() {
  for (TraceReport &trace : report.traces) {
    const TraceTraffic &plain = trace.steps.front().traffic, &now = trace.steps.back().traffic;
    trace.plainly = {0, plain.stores, plain.loads, costOf(plain)};
    trace.extra.stores = now.stores;
    trace.extra.loads = now.loads;
    trace.extra.cost += costOf(now);
  }
}

static void reportTransitions(FuncOp state, std::vector<TransitionReport> &transitions) {
  llvm::StringSet<> called; // jumps to where these begin are said with them
  state.walk([&](ir::EnterOp call) {
    called.insert((call.getCallee() + ".state0").str());
    const TransitionReport way = {TransitionReport::Call, state.getSymName().str(),
                                  call.getResume().value_or("").str(), call.getCallee().str()};
    if (std::find(transitions.begin(), transitions.end(), way) == transitions.end())
      transitions.push_back(way);
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

mlir::LogicalResult FunctionSplitter::run() {
  report.name = function.getSymName().str();
  report.endings = endingsOf(function);

  decide(function);
  insertSuspends(function, summary);
  for (mlir::Location last : endAtLastTraces(function))
    report.lastTraces.push_back(ir::placeOf(last));
  // In a program that is printed for people copies read better than states that no trace has made,
  // unless they are many.
  const bool isForPeople = function->getParentOfType<mlir::ModuleOp>()->hasAttr("rtsl.source");
  cutJoins(function, isForPeople ? JoinOptions::forPeople() : JoinOptions());
  moveVariablesToFrame(function);
  if (isForPeople)
    removeIdleClears(function);
  if (mlir::failed(check("suspend")))
    return mlir::failure();
  listTraces();
  if (options.explain && mlir::failed(reportPlainLiveness("liveness")))
    return mlir::failure();

  if (options.trim)
    trimVectors(function);
  if (mlir::failed(check("trim")))
    return mlir::failure();
  if (options.explain && options.trim && mlir::failed(reportPlainLiveness("trim-vectors")))
    return mlir::failure();

  if (mlir::failed(planAndRematerialise()) || mlir::failed(check("rematerialise")))
    return mlir::failure();

  if (mlir::failed(saveLive(function)) || mlir::failed(check("save")))
    return mlir::failure();

  report.frame = layoutFrame(function);
  if (mlir::failed(check("layout")))
    return mlir::failure();

  auto states = splitStates(function);
  if (mlir::failed(states))
    return mlir::failure();
  for (FuncOp state : *states) {
    report.states.push_back(state.getSymName().str());
    function = state;
    if (mlir::failed(check("split")))
      return mlir::failure();
  }
  if (options.cleanUp && mlir::failed(cleanUp(*states)))
    return mlir::failure();
  FrameTraffic traffic;
  for (FuncOp state : *states) {
    reportTransitions(state, report.transitions);
    if (options.explain)
      traffic.add(state);
  }
  if (options.explain) {
    reportTraffic(options.cleanUp ? "sink-loads" : "split-states", traffic);
    sumUpExtras();
  }
  return mlir::success();
}

/// A function that the machine can run: nothing comes in but the object, and nothing goes out.
bool isRunnable(FuncOp function) {
  return function.getNumResults() == 0 &&
         function.getNumArguments() == (objectOf(function) ? 1u : 0u);
}

/// A method that no class of the program has.
bool isEmpty(FuncOp function) {
  return llvm::isa<mlir::func::ReturnOp>(function.getBody().front().front());
}

} // namespace

void keepTracingMethods(mlir::ModuleOp module) {
  static constexpr llvm::StringLiteral startedByRuntime[] = {
#define RTSL_SLOT(base, method) #method,
#include "language/Slots.def"
#define RTSL_PAYLOAD_SLOT(base, method) #method,
#include "language/PayloadSlots.def"
  };
  for (FuncOp function : tracingFunctions(module)) {
    auto method = function->getAttrOfType<mlir::StringAttr>("rtsl.method");
    if (method && llvm::is_contained(startedByRuntime, method.getValue().split('.').first))
      function->setAttr("rtsl.noinline", mlir::UnitAttr::get(module.getContext()));
  }
  // Of a circle the call through a reference is cut: each goes to an object further down.
  for (FuncOp function : functionsThatMayCallThemselves(module))
    if (function.getSymName().starts_with("dispatch.")) {
      function->setAttr("rtsl.noinline", mlir::UnitAttr::get(module.getContext()));
      function->setAttr("rtsl.framed", mlir::UnitAttr::get(module.getContext()));
    }
}

bool splitAtTrace(mlir::ModuleOp module, const SplitOptions &options, SplitReport &report) {
  inlineTracingCalls(module);
  codegen::Simplify simplify(module.getContext());
  if (options.trim)
    report.trimmed = trimPayloads(module);
  llvm::SmallVector<FuncOp> functions = tracingFunctions(module);
  llvm::SmallPtrSet<mlir::Operation *, 16> listed(functions.begin(), functions.end());
  for (llvm::StringRef name : machineEntries())
    if (auto entry = module.lookupSymbol<FuncOp>(name);
        entry && !entry.isExternal() && !isEmpty(entry) && listed.insert(entry).second)
      functions.push_back(entry);
  for (FuncOp function : module.getOps<FuncOp>())
    if (function->hasAttr("rtsl.states") && listed.insert(function).second)
      functions.push_back(function);
  // What is called comes after its callers, which ask what it writes.
  std::stable_partition(functions.begin(), functions.end(),
                        [](FuncOp function) { return !isFramed(function); });
  const WriteSummary summary(module);
  for (FuncOp function : functions) {
    if (isFramed(function))
      takeArgumentsFromFrame(function);
    if (!isRunnable(function))
      continue; // a function of the author's that others could call, if they were in this program
    FunctionReport ofFunction;
    if (mlir::failed(FunctionSplitter(function, options, simplify, summary, ofFunction).run()))
      return false;
    report.functions.push_back(std::move(ofFunction));
  }
  report.rays = findRays(module);
  report.frameAreas = frameAreas(module);
  report.keptWords = findKeptState(module).words(colorComponentsOf(module));
  if (options.dispatch && mlir::failed(makeDispatch(module)))
    return false;
  return !options.verifyEach || mlir::succeeded(mlir::verify(module));
}

} // namespace rtsl
