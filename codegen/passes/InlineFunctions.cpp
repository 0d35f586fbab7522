//===- InlineFunctions.cpp - inlining -------------------------------------===//
#include "codegen/passes/InlineFunctions.h"

#include "codegen/ir/Attributes.h"
#include "codegen/ir/Rays.h"
#include "codegen/ir/Separate.h"
#include "codegen/ir/dialect/RtslOps.h"

#include "mlir/Analysis/CallGraph.h"
#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "mlir/IR/SymbolTable.h"
#include "mlir/Pass/Pass.h"
#include "mlir/Transforms/Inliner.h"

namespace rtsl::codegen {

namespace {

/// Functions of at most this many operations are inlined wherever they are called.
constexpr unsigned smallFunction = 60;
/// With arithmetic in double, values that cross a call in memory are rounded: calls remain only
/// where inlining would make programs grow without bound.
constexpr unsigned smallFunctionInDouble = 20000;
/// A function that traces: up to this many operations, copies of its code cost less than a frame of
/// its own.
constexpr unsigned smallTracingFunction = 1000;

unsigned operationCount(mlir::func::FuncOp function, unsigned limit) {
  unsigned count = 0;
  function.walk([&](mlir::Operation *) {
    return ++count > limit ? mlir::WalkResult::interrupt() : mlir::WalkResult::advance();
  });
  return count;
}

/// Whether the function itself contains a trace. By then, callees that trace have been inlined, or
/// need a frame anyway. In C++, what traces in another class is not printed as a function either.
bool traces(mlir::func::FuncOp function) {
  return ir::attr::states.isOn(function) || ir::anyOperation(function, [](mlir::Operation *op) {
           return ir::isTrace(op) || llvm::isa<ir::IlluminateOp>(op);
         });
}

struct InlineFunctions : mlir::PassWrapper<InlineFunctions, mlir::OperationPass<mlir::ModuleOp>> {
  MLIR_DEFINE_EXPLICIT_INTERNAL_INLINE_TYPE_ID(InlineFunctions)
  explicit InlineFunctions(bool inlinesAll) : inlinesAll(inlinesAll) {}
  llvm::StringRef getArgument() const override { return "rtsl-inline"; }
  llvm::StringRef getDescription() const override { return "inlines calls"; }

  bool isWorthIt(const mlir::Inliner::ResolvedCall &resolved) {
    auto callee = resolved.targetNode->getCallableRegion()->getParentOfType<mlir::func::FuncOp>();
    auto caller = resolved.call->getParentOfType<mlir::func::FuncOp>();
    if (!callee || !caller || ir::attr::noinline.isOn(callee) || ir::attr::separate.isOn(callee))
      return false;
    if (ir::attr::constructor.isOn(callee) && !ir::attr::constructor.isOn(caller))
      return false;
    if (inlinesAll)
      return true;
    const bool isDouble = ir::attr::inDouble.isOn(getOperation());
    unsigned limit = isDouble         ? smallFunctionInDouble
                     : traces(callee) ? smallTracingFunction
                                      : smallFunction;
    if (operationCount(callee, limit) <= limit)
      return true;
    return callee.isPrivate() && useCount.lookup(callee.getSymNameAttr()) == 1;
  }

  void runOnOperation() override {
    // Counted once: callees are processed before their callers, so a function that is called once
    // has been inlined before the call could be copied. Querying the uses of each callee would walk
    // the whole module each time.
    useCount.clear();
    if (auto uses = mlir::SymbolTable::getSymbolUses(getOperation()))
      for (const mlir::SymbolTable::SymbolUse &use : *uses)
        ++useCount[use.getSymbolRef().getLeafReference()];

    mlir::InlinerConfig config;
    config.setMaxInliningIterations(4);
    config.setCanHandleMultipleBlocks();
    auto runNothing = [](mlir::Pass &, mlir::OpPassManager &, mlir::Operation *) {
      return mlir::success();
    };
    mlir::Inliner inliner(
        getOperation(), getAnalysis<mlir::CallGraph>(), *this, getAnalysisManager(), runNothing,
        config, [this](const mlir::Inliner::ResolvedCall &call) { return isWorthIt(call); });
    if (mlir::failed(inliner.doInlining()))
      signalPassFailure();
  }

private:
  bool inlinesAll;
  llvm::DenseMap<mlir::StringAttr, unsigned> useCount; // before inlining
};

} // namespace

bool isLargeToInline(mlir::func::FuncOp function) {
  return operationCount(function, smallTracingFunction) > smallTracingFunction;
}

std::unique_ptr<mlir::Pass> createInlineFunctionsPass(bool inlinesAll) {
  return std::make_unique<InlineFunctions>(inlinesAll);
}

} // namespace rtsl::codegen
