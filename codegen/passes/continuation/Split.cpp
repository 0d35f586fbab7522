//===- Split.cpp - shaders that trace become state machines ---------------===//
#include "codegen/passes/continuation/Split.h"
#include "codegen/ir/Attributes.h"
#include "codegen/ir/Slots.h"
#include "codegen/passes/continuation/calls/Steps.h"
#include "codegen/passes/continuation/states/Steps.h"

#include "codegen/passes/Simplify.h"
#include "codegen/passes/continuation/Recorder.h"
#include "codegen/passes/continuation/states/KeptState.h"
#include "codegen/passes/continuation/suspend/CutJoins.h"
#include "codegen/passes/variables/HoistVariables.h"

#include "mlir/IR/Verifier.h"

namespace rtsl {

using namespace continuation;

namespace {

/// Runs all steps on one function.
class FunctionSplitter {
public:
  FunctionSplitter(FuncOp function, const SplitOptions &options, const codegen::Simplify &simplify,
                   const WriteSummary &summary, FunctionReport &report)
      : function(function), options(options), simplify(simplify), summary(summary),
        recorder(function, summary, options.explain, report) {}

  mlir::LogicalResult run();

private:
  mlir::LogicalResult check(FuncOp changed, llvm::StringRef step);
  void decide(FuncOp changed);
  mlir::LogicalResult suspend();
  mlir::LogicalResult save();
  mlir::LogicalResult cleanUp(FuncOp state);

  FuncOp function;
  const SplitOptions &options;
  const codegen::Simplify &simplify;
  const WriteSummary &summary;
  Recorder recorder;
};

mlir::LogicalResult FunctionSplitter::check(FuncOp changed, llvm::StringRef step) {
  if (!options.verifyEach || mlir::succeeded(mlir::verify(changed)))
    return mlir::success();
  return changed.emitError() << "`" << changed.getSymName() << "` is broken after the step `"
                             << step << "`";
}

/// One decided branch may decide others.
void FunctionSplitter::decide(FuncOp changed) {
  while (options.isKnown && codegen::decideBranches(changed, options.isKnown))
    simplify.run(changed);
}

/// Ends blocks at their traces, and moves variables that are live across a trace to the frame.
mlir::LogicalResult FunctionSplitter::suspend() {
  // In C++ output, duplicated code is easier to read than additional states, unless there is much
  // of it.
  const bool isForCpp = ir::attr::source.isOn(function->getParentOfType<mlir::ModuleOp>());
  decide(function);
  insertSuspends(function, summary);
  recorder.foundTailTraces(endAtTailTraces(function));
  cutJoins(function, isForCpp ? JoinOptions::forCpp() : JoinOptions());
  moveVariablesToFrame(function);
  if (isForCpp)
    removeIdleClears(function);
  if (mlir::failed(check(function, "suspend")))
    return mlir::failure();
  return recorder.suspended();
}

/// Saves or recomputes each value that is live across a trace.
mlir::LogicalResult FunctionSplitter::save() {
  if (options.trim) {
    trimVectors(function);
    if (mlir::failed(check(function, "trim")) || mlir::failed(recorder.trimmedVectors()))
      return mlir::failure();
  }
  RematerialiseOptions how;
  how.onlyAddresses = !options.rematerialise;
  auto plans = planContinuations(function, how, summary);
  if (mlir::failed(plans))
    return mlir::failure();
  recorder.planned(*plans);
  rematerialise(function, *plans);
  if (mlir::failed(check(function, "rematerialise")))
    return mlir::failure();
  if (mlir::failed(saveLive(function)) || mlir::failed(check(function, "save")))
    return mlir::failure();
  recorder.laidOut(layoutFrame(function));
  return check(function, "layout");
}

mlir::LogicalResult FunctionSplitter::cleanUp(FuncOp state) {
  cleanStores(state);
  recorder.cleanedStores(state);
  sinkLoads(state);
  simplify.run(state);
  decide(state);
  return check(state, "clean-up");
}

mlir::LogicalResult FunctionSplitter::run() {
  if (mlir::failed(suspend()) || mlir::failed(save()))
    return mlir::failure();
  auto states = splitStates(function);
  if (mlir::failed(states))
    return mlir::failure();
  recorder.split(*states);
  for (FuncOp state : *states)
    codegen::hoistVariables(state);
  for (FuncOp state : *states)
    if (mlir::failed(check(state, "split")) || (options.cleanUp && mlir::failed(cleanUp(state))))
      return mlir::failure();
  recorder.finished(*states, options.cleanUp);
  return mlir::success();
}

/// Can the machine run the function? It has no parameters except the object, and no result.
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
    auto method = ir::attr::methodName.of(function);
    if (method && llvm::is_contained(startedByRuntime, method.getValue().split('.').first))
      ir::attr::noinline.set(function);
  }
  // Cycles are cut at calls through references: each leads to an object further down a chain of
  // references.
  for (FuncOp function : functionsThatMayCallThemselves(module))
    if (ir::attr::dispatch.isOn(function)) {
      ir::attr::noinline.set(function);
      ir::attr::framed.set(function);
    }
}

bool splitAtTrace(mlir::ModuleOp module, const SplitOptions &options, SplitReport &report) {
  inlineTracingCalls(module);
  codegen::Simplify simplify(module.getContext());
  if (options.trim)
    report.trimmed = trimPayloads(module);
  llvm::SmallVector<FuncOp> functions = tracingFunctions(module);
  llvm::SmallPtrSet<mlir::Operation *, 16> listed(functions.begin(), functions.end());
  for (llvm::StringRef slot : machineSlots())
    if (auto entry = ir::entryPoint(module, slot);
        entry && !entry.isExternal() && !isEmpty(entry) && listed.insert(entry).second)
      functions.push_back(entry);
  for (FuncOp function : module.getOps<FuncOp>())
    if (ir::attr::states.isOn(function) && listed.insert(function).second)
      functions.push_back(function);
  // Callees come after their callers, which need the summary of their writes.
  std::stable_partition(functions.begin(), functions.end(),
                        [](FuncOp function) { return !isFramed(function); });
  const WriteSummary summary(module);
  for (FuncOp function : functions) {
    if (isFramed(function))
      takeArgumentsFromFrame(function);
    if (!isRunnable(function))
      continue; // a function that nothing in this program calls
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
