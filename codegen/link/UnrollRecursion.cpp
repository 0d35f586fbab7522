//===- UnrollRecursion.cpp - copies of recursive functions ----------------===//
//
//   func @dispatch.Layer.at(%o, %p)              func @dispatch.Layer.at   { call @Mixed.at }
//     { call @Mixed.at }                  ==>    func @Mixed.at
//   func @Mixed.at(%self, %p)                      { call @dispatch.Layer.at.2 }
//     { call @dispatch.Layer.at(%inner, ...) }   func @dispatch.Layer.at.2 { call @Mixed.at.2 }
//                                                func @Mixed.at.2          { 0 }
//
// A GPU has no memory for recursion whose depth depends on the scene; and recursive functions are
// never inlined. Each iteration of such a cycle calls through a reference, to an object that is
// further down a chain of references (docs/language.md, func.recursion), and the lengths of these
// chains are known when the objects are made. Functions that trace have frames of their own
// (codegen/passes/continuation/calls/CallFrames.cpp).
//
//===----------------------------------------------------------------------===//
#include "codegen/link/UnrollRecursion.h"

#include "codegen/ir/Attributes.h"
#include "codegen/ir/BaseAddress.h"
#include "codegen/ir/Rays.h"
#include "codegen/ir/Rtsl.h"
#include "codegen/ir/WithoutCasts.h"
#include "codegen/link/CallGraph.h"
#include "codegen/link/steps/Steps.h"

#include "mlir/Analysis/CallGraph.h"
#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "mlir/IR/SymbolTable.h"
#include "llvm/ADT/SCCIterator.h"
#include "llvm/ADT/SetVector.h"

#include <map>

namespace rtsl {

namespace {

using mlir::func::CallOp;
using mlir::func::FuncOp;

using Cycle = llvm::SmallSetVector<mlir::Operation *, 8>;

/// The cycles of functions that may call one another.
std::vector<Cycle> findCycles(mlir::ModuleOp ir) {
  std::vector<Cycle> cycles;
  const mlir::CallGraph graph(ir);
  for (auto group = llvm::scc_begin(&graph); !group.isAtEnd(); ++group) {
    if (!group.hasCycle())
      continue;
    Cycle cycle;
    for (const mlir::CallGraphNode *node : *group)
      if (!node->isExternal())
        cycle.insert(node->getCallableRegion()->getParentOp());
    cycles.push_back(std::move(cycle));
  }
  return cycles;
}

/// Do the functions or their callees send rays?
bool traces(const Cycle &cycle, mlir::ModuleOp ir) {
  const mlir::SymbolTable symbols(ir);
  linking::Contains traces(symbols, ir::isTrace);
  return llvm::any_of(cycle, [&](mlir::Operation *function) { return traces(function); });
}

bool isDispatch(mlir::Operation *function) {
  return ir::attr::dispatch.isOn(function);
}

/// How a function reaches an object that it calls a method of.
enum class Reached { AsItself, ByMember, Otherwise };

Reached howReached(mlir::Value object, FuncOp function) {
  object = ir::withoutCasts(object);
  if (function.getNumArguments() != 0 && object == function.getArgument(0))
    return Reached::AsItself;
  auto load = object.getDefiningOp<ir::LoadOp>();
  auto member = load
                    ? llvm::dyn_cast_or_null<ir::MemberOp>(ir::variableOperation(load.getAddress()))
                    : nullptr;
  return member && howReached(member.getObject(), function) != Reached::Otherwise
             ? Reached::ByMember
             : Reached::Otherwise;
}

/// Of the object of a call within a cycle.
Reached howReached(CallOp call) {
  return call.getNumOperands() == 0
             ? Reached::Otherwise
             : howReached(call.getOperand(0), call->getParentOfType<FuncOp>());
}

/// Does no call within the cycle lead up a chain of references?
bool onlyDescends(const Cycle &cycle, mlir::ModuleOp ir) {
  const mlir::SymbolTable symbols(ir);
  return llvm::none_of(cycle, [&](mlir::Operation *function) {
    const mlir::WalkResult result = function->walk([&](CallOp call) {
      mlir::Operation *callee = symbols.lookup(call.getCallee());
      const bool isWithin = callee && cycle.contains(callee);
      return isWithin && howReached(call) == Reached::Otherwise ? mlir::WalkResult::interrupt()
                                                                : mlir::WalkResult::advance();
    });
    return result.wasInterrupted();
  });
}

class Unroller {
public:
  Unroller(mlir::ModuleOp ir, const Cycle &cycle, std::uint32_t levels)
      : ir(ir), symbols(ir), cycle(cycle), levels(levels) {}

  void run() {
    for (mlir::Operation *function : cycle) // before any copy calls another one
      originals[function] = function->clone();
    for (mlir::Operation *function : cycle)
      copies[{function, 1}] = llvm::cast<FuncOp>(function);
    for (mlir::Operation *function : cycle)
      redirect(llvm::cast<FuncOp>(function), 1);
    for (auto &[function, original] : originals)
      original->destroy();
  }

private:
  /// Calls of functions of the cycle lead to the copies of the same level, and calls through
  /// references to other objects to those of the next level.
  void redirect(FuncOp function, std::uint32_t level) {
    function.walk([&](CallOp call) {
      mlir::Operation *callee = symbols.lookup(call.getCallee());
      if (!callee || !cycle.contains(callee))
        return;
      const bool isNext = isDispatch(callee) && howReached(call) != Reached::AsItself;
      const std::uint32_t below = isNext ? level + 1 : level;
      if (below == level && level == 1)
        return;
      if (below <= levels) {
        call.setCallee(copy(callee, below).getSymName());
        return;
      }
      mlir::OpBuilder builder(call); // no chain of references is this long
      for (mlir::Value result : call.getResults())
        result.replaceAllUsesWith(ir::createZero(builder, call.getLoc(), result.getType()));
      call.erase();
    });
  }

  FuncOp copy(mlir::Operation *function, std::uint32_t level) {
    if (FuncOp known = copies[{function, level}])
      return known;
    auto made = llvm::cast<FuncOp>(originals.at(function)->clone());
    made.setSymName(llvm::cast<FuncOp>(function).getSymName().str() + "." + std::to_string(level));
    made.setPrivate();
    ir::attr::exported.removeFrom(made);
    ir::attr::methodName.removeFrom(made);
    symbols.insert(made, std::next(mlir::Block::iterator(function)));
    copies[{function, level}] = made;
    redirect(made, level);
    return made;
  }

  mlir::ModuleOp ir;
  mlir::SymbolTable symbols;
  const Cycle &cycle;
  const std::uint32_t levels;
  std::map<mlir::Operation *, mlir::Operation *> originals;
  std::map<std::pair<mlir::Operation *, std::uint32_t>, FuncOp> copies;
};

} // namespace

void unrollRecursion(mlir::ModuleOp ir, std::uint32_t referenceChain) {
  for (const Cycle &cycle : findCycles(ir)) {
    if (traces(cycle, ir))
      continue;
    // Each call through a member leads to the next object. If there are others, one of a member
    // comes between two calls of the same function.
    const auto dispatches =
        static_cast<std::uint32_t>(onlyDescends(cycle, ir) ? 1 : llvm::count_if(cycle, isDispatch));
    const std::uint64_t levels =
        std::uint64_t(std::max(1u, referenceChain)) * std::max(1u, dispatches);
    if (levels <= mostRecursionLevels)
      Unroller(ir, cycle, static_cast<std::uint32_t>(levels)).run();
  }
}

FuncOp recursiveFunction(mlir::ModuleOp ir) {
  for (const Cycle &cycle : findCycles(ir)) {
    const auto method = llvm::find_if_not(cycle, isDispatch);
    if (!traces(cycle, ir))
      return llvm::cast<FuncOp>(method == cycle.end() ? cycle.front() : *method);
  }
  return nullptr;
}

} // namespace rtsl
