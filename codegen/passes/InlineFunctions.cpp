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
#include "llvm/ADT/DenseSet.h"

#include <algorithm>

namespace rtsl::codegen {

namespace {

/// Functions of at most this many operations are inlined wherever they are called.
constexpr unsigned smallFunction = 60;
/// With arithmetic in double, values that cross a call in memory are rounded: calls remain only
/// where inlining would make programs grow without bound.
constexpr unsigned smallFunctionInDouble = 20000;
/// Functions that are used once are moved into each other up to this depth: the inliner adds a call
/// to the location of each operation each time, in a time that grows with the depth.
constexpr unsigned mostCallsMoved = 64;
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

/// Finds functions without which no cycle of calls is left: those at which a depth-first walk
/// closes one. They are not inlined ("loop breakers" of Peyton Jones and Marlow, Secrets of the
/// Glasgow Haskell Compiler inliner, 2002): if all functions of a cycle were, a caller would unroll
/// it as far as the inliner goes, and each caller of that one would unroll again what is left.
class CycleBreakers {
public:
  explicit CycleBreakers(const mlir::CallGraph &graph) {
    for (const mlir::CallGraphNode *node : graph)
      if (!visited.contains(node))
        visit(node);
  }
  bool contains(const mlir::CallGraphNode *node) const { return breakers.contains(node); }

private:
  void visit(const mlir::CallGraphNode *node) {
    visited[node] = State::Open;
    for (const mlir::CallGraphNode::Edge &edge : *node) {
      const auto callee = visited.find(edge.getTarget());
      if (callee == visited.end())
        visit(edge.getTarget());
      else if (callee->second == State::Open)
        breakers.insert(callee->first);
    }
    visited[node] = State::Done;
  }

  enum class State : std::uint8_t { Open, Done };
  llvm::DenseMap<const mlir::CallGraphNode *, State> visited;
  llvm::DenseSet<const mlir::CallGraphNode *> breakers;
};

/// How often each function is used, now.
class UseCounts {
public:
  explicit UseCounts(mlir::Region &body) { add(body); }

  bool isOne(mlir::func::FuncOp function) const {
    return function.isPrivate() && uses.lookup(function.getSymNameAttr()) == 1;
  }
  /// A call is to be inlined: what the function uses is used once more, unless this was the only
  /// use and the function is removed.
  void inlineCall(mlir::func::FuncOp callee) {
    if (!isOne(callee))
      add(callee.getBody());
    --uses[callee.getSymNameAttr()];
  }

private:
  void add(mlir::Region &body) {
    if (const auto all = mlir::SymbolTable::getSymbolUses(&body))
      for (const mlir::SymbolTable::SymbolUse &use : *all)
        ++uses[use.getSymbolRef().getLeafReference()];
  }
  llvm::DenseMap<mlir::StringAttr, unsigned> uses;
};

struct InlineFunctions : mlir::PassWrapper<InlineFunctions, mlir::OperationPass<mlir::ModuleOp>> {
  MLIR_DEFINE_EXPLICIT_INTERNAL_INLINE_TYPE_ID(InlineFunctions)
  explicit InlineFunctions(bool inlinesAll) : inlinesAll(inlinesAll) {}
  llvm::StringRef getArgument() const override { return "rtsl-inline"; }
  llvm::StringRef getDescription() const override { return "inlines calls"; }

  void runOnOperation() override {
    inLookup.clear();
    for (auto function : getOperation().getOps<mlir::func::FuncOp>())
      if (ir::attr::inLookup.isOn(function))
        inLookup.insert(function.getSymNameAttr());
    auto &graph = getAnalysis<mlir::CallGraph>();
    const CycleBreakers breakers(graph);
    UseCounts uses(getOperation().getBodyRegion());
    llvm::DenseMap<mlir::Operation *, unsigned> depths; // of calls that were inlined in a function

    mlir::InlinerConfig config;
    config.setMaxInliningIterations(4);
    config.setCanHandleMultipleBlocks();
    auto runNothing = [](mlir::Pass &, mlir::OpPassManager &, mlir::Operation *) {
      return mlir::success();
    };
    auto decide = [&](const mlir::Inliner::ResolvedCall &resolved) {
      auto callee = resolved.targetNode->getCallableRegion()->getParentOfType<mlir::func::FuncOp>();
      auto caller = resolved.call->getParentOfType<mlir::func::FuncOp>();
      if (!callee || !caller || breakers.contains(resolved.targetNode) ||
          !isAllowed(callee, caller) ||
          !(isSmall(callee) ? !isBetterShared(callee)
                            : uses.isOne(callee) && depths.lookup(callee) < mostCallsMoved))
        return false;
      uses.inlineCall(callee);
      depths[caller] = std::max(depths[caller], depths.lookup(callee) + 1);
      return true;
    };
    mlir::Inliner inliner(getOperation(), graph, *this, getAnalysisManager(), runNothing, config,
                          decide);
    if (mlir::failed(inliner.doInlining()))
      signalPassFailure();
  }

private:
  static bool isAllowed(mlir::func::FuncOp callee, mlir::func::FuncOp caller) {
    return !ir::attr::noinline.isOn(callee) && !ir::attr::separate.isOn(callee) &&
           (!ir::attr::constructor.isOn(callee) || ir::attr::constructor.isOn(caller));
  }

  /// Is a copy for each caller worth it?
  bool isSmall(mlir::func::FuncOp callee) {
    if (inlinesAll)
      return true;
    const unsigned limit = isDouble()       ? smallFunctionInDouble
                           : traces(callee) ? smallTracingFunction
                                            : smallFunction;
    return operationCount(callee, limit) <= limit;
  }

  /// Equal calls of what looks up textures by code that was not inlined are shared
  /// (calls/ShareCalls.h), which those of the textures cannot be.
  bool isBetterShared(mlir::func::FuncOp callee) {
    return !inlinesAll && !isDouble() && !ir::attr::inLookup.isOn(callee) &&
           ir::anyOperation(callee, [&](mlir::Operation *op) {
             auto call = llvm::dyn_cast<mlir::func::CallOp>(op);
             return call && inLookup.contains(call.getCalleeAttr().getAttr());
           });
  }
  bool isDouble() { return ir::attr::inDouble.isOn(getOperation()); }

  bool inlinesAll;
  llvm::DenseSet<mlir::StringAttr> inLookup; // functions that a texture's `lookup` may run
};

} // namespace

bool isLargeToInline(mlir::func::FuncOp function) {
  return operationCount(function, smallTracingFunction) > smallTracingFunction;
}

std::unique_ptr<mlir::Pass> createInlineFunctionsPass(bool inlinesAll) {
  return std::make_unique<InlineFunctions>(inlinesAll);
}

} // namespace rtsl::codegen
