//===- Endings.cpp - how chains of rays end -------------------------------===//
//
// For the report: a program that traces on every path ends only by the depth limit. In other
// programs, this finds the branches with one successor from which every path traces and another
// from which some path does not, and the sources of their conditions.
//
//===----------------------------------------------------------------------===//
#include "codegen/ir/IncomingEdges.h"
#include "codegen/ir/Rays.h"
#include "codegen/passes/continuation/suspend/Steps.h"

#include "mlir/IR/RegionGraphTraits.h"
#include "llvm/ADT/SetVector.h"
#include "llvm/ADT/SmallPtrSet.h"

#include <algorithm>

namespace rtsl::continuation {

namespace {

bool traces(mlir::Block &block) {
  return llvm::any_of(block, [](mlir::Operation &op) { return ir::isTrace(&op); });
}

/// Blocks from whose beginning some path leads to the end of the function without a trace.
llvm::SmallPtrSet<mlir::Block *, 16> blocksThatMayEnd(FuncOp function) {
  llvm::SmallPtrSet<mlir::Block *, 16> mayEnd;
  bool changed = true;
  while (changed) {
    changed = false;
    for (mlir::Block &block : llvm::reverse(function.getBody())) { // successors mostly come later
      if (mayEnd.contains(&block) || traces(block))
        continue;
      if (block.getNumSuccessors() == 0 ||
          llvm::any_of(block.getSuccessors(),
                       [&](mlir::Block *next) { return mayEnd.contains(next); }))
        changed |= mayEnd.insert(&block).second;
    }
  }
  return mayEnd;
}

/// Adds the sources of a value that have a name in the source text.
void addSources(mlir::Value value, llvm::SetVector<mlir::Value> &seen,
                std::vector<std::string> &sources) {
  if (!seen.insert(value))
    return;
  auto add = [&](const char *source) {
    if (std::find(sources.begin(), sources.end(), source) == sources.end())
      sources.push_back(source);
  };
  if (auto argument = llvm::dyn_cast<mlir::BlockArgument>(value)) {
    ir::forEachEdgeInto(*argument.getOwner(), [&](ir::Edge edge) {
      if (mlir::Value passed = edge.passedTo(argument))
        addSources(passed, seen, sources);
    });
    return;
  }
  mlir::Operation *op = value.getDefiningOp();
  if (llvm::isa<ir::RandOp>(op))
    add("rand()");
  if (llvm::isa<ir::PayloadOp>(op))
    add("its payload");
  if (auto state = llvm::dyn_cast<ir::StateOp>(op); state && state.getName() == "Depth")
    add("rt_Depth");
  for (mlir::Value operand : op->getOperands())
    addSources(operand, seen, sources);
}

} // namespace

Endings endingsOf(FuncOp function) {
  Endings endings;
  const auto mayEnd = blocksThatMayEnd(function);
  endings.alwaysTraces = !mayEnd.contains(&function.getBody().front());
  llvm::SetVector<mlir::Value> seen;
  for (mlir::Block &block : function.getBody()) {
    const bool isDecision = mayEnd.contains(&block) &&
                            llvm::any_of(block.getSuccessors(),
                                         [&](mlir::Block *next) { return !mayEnd.contains(next); });
    if (isDecision)
      for (mlir::Value operand : block.getTerminator()->getOperands())
        if (operand.getType().isInteger())
          addSources(operand, seen, endings.by);
  }
  return endings;
}

} // namespace rtsl::continuation
