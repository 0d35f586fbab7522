//===- Split.cpp - shaders that trace become state machines ---------------===//
#include "codegen/passes/continuation/Split.h"

#include "codegen/ir/Layout.h"
#include "codegen/passes/Simplify.h"
#include "codegen/passes/continuation/CostTable.h"
#include "codegen/passes/continuation/Names.h"

#include "mlir/IR/Verifier.h"
#include "llvm/ADT/StringSet.h"

namespace rtsl {

using namespace continuation;

namespace {

/// Names and bytes of what would be or is saved at a trace.
void describe(llvm::ArrayRef<mlir::Value> values, UniqueNames &uniqueNames,
              std::vector<std::string> &names, std::uint32_t &bytes,
              std::vector<std::uint32_t> *sizes = nullptr) {
  unsigned bools = 0;
  for (mlir::Value value : values) {
    names.push_back(uniqueNames.of(value));
    const bool isBool = value.getType().isInteger(1);
    const std::uint32_t size = isBool ? 0 : ir::sizeInBytes(value.getType());
    bools += isBool;
    bytes += size;
    if (sizes)
      sizes->push_back(size);
  }
  bytes += (bools + 31) / 32 * 4;
}

/// Takes one function through all steps.
class FunctionSplitter {
public:
  FunctionSplitter(FuncOp function, const SplitOptions &options, const codegen::Simplify &simplify,
                   FunctionReport &report)
      : function(function), options(options), simplify(simplify), report(report) {}

  mlir::LogicalResult run();

private:
  mlir::LogicalResult check(llvm::StringRef step);
  mlir::LogicalResult reportPlainLiveness();
  mlir::LogicalResult planAndRematerialise();
  mlir::LogicalResult cleanUp(llvm::ArrayRef<FuncOp> states);

  FuncOp function;
  const SplitOptions &options;
  const codegen::Simplify &simplify;
  FunctionReport &report;
  UniqueNames plainNames;
};

mlir::LogicalResult FunctionSplitter::check(llvm::StringRef step) {
  if (!options.verifyEach || mlir::succeeded(mlir::verify(function)))
    return mlir::success();
  return function.emitError() << "`" << function.getSymName() << "` is broken after the step `"
                              << step << "`";
}

/// What would be saved if nothing were clever: the figure that all others are compared with.
mlir::LogicalResult FunctionSplitter::reportPlainLiveness() {
  RematerialiseOptions plain;
  plain.onlyAddresses = true;
  auto plans = planContinuations(function, plain);
  if (mlir::failed(plans))
    return mlir::failure();
  for (const SuspendPlan &plan : *plans) {
    TraceReport trace;
    trace.place = ir::placeOf(ir::SuspendOp(plan.suspend).getLoc());
    trace.onlyScalesAndAdds = onlyScalesAndAdds(plan.suspend);
    if (auto call = llvm::dyn_cast_or_null<ir::EnterOp>(plan.suspend->getPrevNode()))
      trace.callee = call.getCallee().str();
    trace.resumesAt = report.name + ".state" + std::to_string(report.traces.size() + 1);
    describe(plan.saved, plainNames, trace.live, trace.liveBytes);
    report.traces.push_back(std::move(trace));
  }
  return mlir::success();
}

mlir::LogicalResult FunctionSplitter::planAndRematerialise() {
  RematerialiseOptions how;
  how.onlyAddresses = !options.rematerialise;
  auto plans = planContinuations(function, how);
  if (mlir::failed(plans))
    return mlir::failure();
  UniqueNames names;
  for (auto [plan, trace] : llvm::zip(*plans, report.traces)) {
    describe(plan.saved, names, trace.saved, trace.savedBytes, &trace.savedSizes);
    llvm::StringSet<> live;
    for (const std::string &name : trace.live)
      live.insert(name);
    for (mlir::Value value : plan.recomputed) {
      trace.rematerialisedCost += recomputeCost(value.getDefiningOp());
      if (std::string name = plainNames.of(value); live.contains(name))
        trace.rematerialised.push_back(name);
    }
  }
  rematerialise(function, *plans);
  return mlir::success();
}

mlir::LogicalResult FunctionSplitter::cleanUp(llvm::ArrayRef<FuncOp> states) {
  for (FuncOp state : states) {
    function = state;
    simplify.run(state);
    const bool isCleaner = cleanStores(state);
    if (sinkLoads(state) || isCleaner)
      simplify.run(state);
    if (mlir::failed(check("clean-up")))
      return mlir::failure();
  }
  return mlir::success();
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

  insertSuspends(function);
  for (mlir::Location last : endAtLastTraces(function))
    report.lastTraces.push_back(ir::placeOf(last));
  moveVariablesToFrame(function);
  if (mlir::failed(check("suspend")) || mlir::failed(reportPlainLiveness()))
    return mlir::failure();

  if (options.trim)
    trimVectors(function);
  if (mlir::failed(check("trim")))
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
  for (FuncOp state : *states)
    reportTransitions(state, report.transitions);
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
#include "runtime/device/Slots.def"
#define RTSL_PAYLOAD_SLOT(base, method) #method,
#include "runtime/device/PayloadSlots.def"
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
  for (llvm::StringRef name : machineEntries())
    if (auto entry = module.lookupSymbol<FuncOp>(name);
        entry && !entry.isExternal() && !isEmpty(entry) && !llvm::is_contained(functions, entry))
      functions.push_back(entry);
  // What is called comes after its callers, which ask what it writes.
  std::stable_partition(functions.begin(), functions.end(), [](FuncOp function) { return !isFramed(function); });
  for (FuncOp function : functions) {
    if (isFramed(function))
      takeArgumentsFromFrame(function);
    if (!isRunnable(function))
      continue; // a function of the author's that others could call, if they were in this program
    FunctionReport ofFunction;
    if (mlir::failed(FunctionSplitter(function, options, simplify, ofFunction).run()))
      return false;
    report.functions.push_back(std::move(ofFunction));
  }
  report.rays = findRays(module);
  report.frameAreas = frameAreas(module);
  if (options.dispatch && mlir::failed(makeDispatch(module)))
    return false;
  return !options.verifyEach || mlir::succeeded(mlir::verify(module));
}

} // namespace rtsl
