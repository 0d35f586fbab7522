//===- ContinuationPasses.cpp - the steps of splitting as passes ----------===//
//
// For rtsl-opt: those of codegen/passes/continuation/common/Steps.def, and the ones with options.
//
//===----------------------------------------------------------------------===//
#include "tools/rtsl-opt/ContinuationPasses.h"

#include "codegen/explain/ReportJson.h"
#include "codegen/explain/ReportText.h"
#include "codegen/passes/continuation/Split.h"
#include "codegen/passes/continuation/calls/Steps.h"
#include "codegen/passes/continuation/common/Names.h"
#include "codegen/passes/continuation/states/Steps.h"
#include "codegen/passes/continuation/suspend/CutJoins.h"

#include "mlir/Pass/Pass.h"
#include "mlir/Pass/PassRegistry.h"

#include <type_traits>

namespace rtsl {

using namespace continuation;

namespace {

/// A step on one function.
template <typename Derived>
struct FunctionStep : mlir::PassWrapper<Derived, mlir::OperationPass<FuncOp>> {
  llvm::StringRef getArgument() const override { return Derived::argument; }
  llvm::StringRef getDescription() const override { return Derived::description; }
  void getDependentDialects(mlir::DialectRegistry &registry) const override {
    registry.insert<ir::RtslDialect>();
  }
  void runOnOperation() override {
    if (this->getOperation().isExternal())
      return;
    if (mlir::failed(static_cast<Derived *>(this)->step(this->getOperation())))
      this->signalPassFailure();
  }
};

template <typename Step>
mlir::LogicalResult resultOf(Step step) {
  if constexpr (std::is_same_v<decltype(step()), mlir::LogicalResult>) {
    return step();
  } else {
    step();
    return mlir::success();
  }
}

#define RTSL_STEP(function, pass, Meaning)                                                         \
  struct function##Pass : FunctionStep<function##Pass> {                                           \
    MLIR_DEFINE_EXPLICIT_INTERNAL_INLINE_TYPE_ID(function##Pass)                                   \
    static constexpr llvm::StringLiteral argument = pass;                                          \
    static constexpr llvm::StringLiteral description = Meaning;                                    \
    mlir::LogicalResult step(FuncOp op) {                                                          \
      return resultOf([&] { return function(op); });                                               \
    }                                                                                              \
  };
#include "codegen/passes/continuation/common/Steps.def"

struct CutJoinsPass : FunctionStep<CutJoinsPass> {
  MLIR_DEFINE_EXPLICIT_INTERNAL_INLINE_TYPE_ID(CutJoinsPass)
  static constexpr llvm::StringLiteral argument = "rtsl-cut-joins";
  static constexpr llvm::StringLiteral description =
      "makes states of code that many states would copy";
  CutJoinsPass() = default;
  CutJoinsPass(const CutJoinsPass &other) : FunctionStep(other) {}
  Option<unsigned> free{*this, "free",
                        llvm::cl::desc("number of copied operations that is always accepted"),
                        llvm::cl::init(4000)};
  Option<unsigned> copies{*this, "copies",
                          llvm::cl::desc("accepted factor of the function's operations"),
                          llvm::cl::init(4)};
  Option<unsigned> shortest{*this, "shortest",
                            llvm::cl::desc("least number of operations between two cuts"),
                            llvm::cl::init(16)};
  mlir::LogicalResult step(FuncOp function) {
    JoinOptions options;
    options.free = free;
    options.copies = copies;
    options.shortest = shortest;
    cutJoins(function, options);
    return mlir::success();
  }
};

struct RematerialisePass : FunctionStep<RematerialisePass> {
  MLIR_DEFINE_EXPLICIT_INTERNAL_INLINE_TYPE_ID(RematerialisePass)
  static constexpr llvm::StringLiteral argument = "rtsl-rematerialise";
  static constexpr llvm::StringLiteral description =
      "recomputes values after a trace that are cheaper to recompute than to save";
  RematerialisePass() = default;
  RematerialisePass(const RematerialisePass &other) : FunctionStep(other) {}
  Option<bool> onlyAddresses{*this, "only-addresses",
                             llvm::cl::desc("recompute only values that cannot be saved")};
  mlir::LogicalResult step(FuncOp function) {
    RematerialiseOptions options;
    options.onlyAddresses = onlyAddresses;
    auto plans = planContinuations(function, options);
    if (mlir::succeeded(plans))
      rematerialise(function, *plans);
    return plans;
  }
};

/// A step on the module.
template <typename Derived>
struct ModuleStep : mlir::PassWrapper<Derived, mlir::OperationPass<mlir::ModuleOp>> {
  llvm::StringRef getArgument() const override { return Derived::argument; }
  llvm::StringRef getDescription() const override { return Derived::description; }
  void getDependentDialects(mlir::DialectRegistry &registry) const override {
    registry.insert<ir::RtslDialect>();
  }
  void runOnOperation() override {
    if (mlir::failed(static_cast<Derived *>(this)->step(this->getOperation())))
      this->signalPassFailure();
  }
};

struct InlineTracingPass : ModuleStep<InlineTracingPass> {
  MLIR_DEFINE_EXPLICIT_INTERNAL_INLINE_TYPE_ID(InlineTracingPass)
  static constexpr llvm::StringLiteral argument = "rtsl-inline-tracing";
  static constexpr llvm::StringLiteral description = "inlines calls of functions that trace";
  mlir::LogicalResult step(mlir::ModuleOp module) {
    inlineTracingCalls(module);
    return mlir::success();
  }
};

struct TrimPayloadsPass : ModuleStep<TrimPayloadsPass> {
  MLIR_DEFINE_EXPLICIT_INTERNAL_INLINE_TYPE_ID(TrimPayloadsPass)
  static constexpr llvm::StringLiteral argument = "rtsl-trim-payloads";
  static constexpr llvm::StringLiteral description =
      "removes fields of payloads that are never read";
  mlir::LogicalResult step(mlir::ModuleOp module) {
    trimPayloads(module);
    return mlir::success();
  }
};

struct SplitStatesPass : ModuleStep<SplitStatesPass> {
  MLIR_DEFINE_EXPLICIT_INTERNAL_INLINE_TYPE_ID(SplitStatesPass)
  static constexpr llvm::StringLiteral argument = "rtsl-split-states";
  static constexpr llvm::StringLiteral description = "a function for each resume point";
  mlir::LogicalResult step(mlir::ModuleOp module) {
    for (FuncOp function : tracingFunctions(module))
      if (mlir::failed(splitStates(function)))
        return mlir::failure();
    return mlir::success();
  }
};

struct DispatchPass : ModuleStep<DispatchPass> {
  MLIR_DEFINE_EXPLICIT_INTERNAL_INLINE_TYPE_ID(DispatchPass)
  static constexpr llvm::StringLiteral argument = "rtsl-dispatch";
  static constexpr llvm::StringLiteral description =
      "numbers states and makes the functions that the machine calls";
  mlir::LogicalResult step(mlir::ModuleOp module) { return makeDispatch(module); }
};

struct SplitPass : ModuleStep<SplitPass> {
  MLIR_DEFINE_EXPLICIT_INTERNAL_INLINE_TYPE_ID(SplitPass)
  static constexpr llvm::StringLiteral argument = "rtsl-split";
  static constexpr llvm::StringLiteral description = "splits functions at their traces: all steps";
  SplitPass() = default;
  SplitPass(const SplitPass &other) : ModuleStep(other) {}
  Option<bool> noRematerialise{*this, "no-rematerialise", llvm::cl::desc("save all live values")};
  Option<bool> noTrim{*this, "no-trim", llvm::cl::desc("save whole vectors")};
  Option<bool> noCleanUp{*this, "no-clean-up", llvm::cl::desc("keep all stores and loads")};
  Option<bool> noDispatch{*this, "no-dispatch", llvm::cl::desc("leave states without numbers")};
  Option<std::string> reportAs{
      *this, "report", llvm::cl::desc("what was saved: `text` or `json`, to standard error")};
  mlir::LogicalResult step(mlir::ModuleOp module) {
    SplitOptions options;
    options.rematerialise = !noRematerialise;
    options.trim = !noTrim;
    options.cleanUp = !noCleanUp;
    options.dispatch = !noDispatch;
    options.explain = !reportAs.empty();
    options.verifyEach = true;
    SplitReport report;
    bool done = splitAtTrace(module, options, report);
    if (reportAs == "text")
      llvm::errs() << toText(report);
    else if (reportAs == "json")
      llvm::errs() << toJson(report);
    return mlir::success(done);
  }
};

} // namespace

void registerContinuationPasses() {
#define RTSL_STEP(function, pass, Meaning) mlir::PassRegistration<function##Pass>();
#include "codegen/passes/continuation/common/Steps.def"
  mlir::PassRegistration<InlineTracingPass>();
  mlir::PassRegistration<CutJoinsPass>();
  mlir::PassRegistration<RematerialisePass>();
  mlir::PassRegistration<TrimPayloadsPass>();
  mlir::PassRegistration<SplitStatesPass>();
  mlir::PassRegistration<DispatchPass>();
  mlir::PassRegistration<SplitPass>();
}

} // namespace rtsl
