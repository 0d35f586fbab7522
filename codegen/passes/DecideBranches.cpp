//===- DecideBranches.cpp - branches on known conditions ------------------===//
#include "codegen/passes/DecideBranches.h"

#include "mlir/Dialect/Arith/IR/Arith.h"
#include "mlir/Dialect/ControlFlow/IR/ControlFlowOps.h"
#include "mlir/IR/Builders.h"
#include "mlir/IR/Dominance.h"
#include "mlir/IR/Matchers.h"

namespace rtsl::codegen {

namespace arith = mlir::arith;
namespace cf = mlir::cf;

/// The condition without its negations; each one flips `isOpposite`.
static mlir::Value withoutNegation(mlir::Value condition, bool &isOpposite) {
  while (auto negation = condition.getDefiningOp<arith::XOrIOp>()) {
    if (!mlir::matchPattern(negation.getRhs(), mlir::m_One()))
      break;
    condition = negation.getLhs();
    isOpposite = !isOpposite;
  }
  return condition;
}

/// The value of a condition if every path to the branch takes one edge of an earlier branch on the
/// same condition or its opposite.
static std::optional<bool> passedBefore(mlir::Value condition, cf::CondBranchOp branch,
                                        mlir::DominanceInfo &dominance) {
  for (mlir::Operation *user : condition.getUsers()) {
    if (auto negation = llvm::dyn_cast<arith::XOrIOp>(user);
        negation && mlir::matchPattern(negation.getRhs(), mlir::m_One()))
      if (std::optional<bool> opposite = passedBefore(negation, branch, dominance))
        return !*opposite;
    auto before = llvm::dyn_cast<cf::CondBranchOp>(user);
    if (!before || before == branch || before.getTrueDest() == before.getFalseDest())
      continue;
    for (const bool way : {true, false}) {
      mlir::Block *target = way ? before.getTrueDest() : before.getFalseDest();
      if (target->getSinglePredecessor() && dominance.dominates(target, branch->getBlock()))
        return way;
    }
  }
  return std::nullopt;
}

bool decideBranches(mlir::func::FuncOp function, const KnownCondition &isKnown) {
  if (function.isExternal())
    return false;
  mlir::DominanceInfo dominance(function);
  bool decided = false;
  for (mlir::Block &block : function.getBody()) {
    auto branch = llvm::dyn_cast<cf::CondBranchOp>(block.getTerminator());
    if (!branch || mlir::matchPattern(branch.getCondition(), mlir::m_Constant()))
      continue;
    bool isOpposite = false;
    const mlir::Value condition = withoutNegation(branch.getCondition(), isOpposite);
    std::optional<bool> known = isKnown(condition);
    if (!known)
      known = passedBefore(condition, branch, dominance);
    if (!known)
      continue;
    mlir::OpBuilder builder(branch);
    branch.getConditionMutable().assign(arith::ConstantOp::create(
        builder, branch.getLoc(), builder.getBoolAttr(*known != isOpposite)));
    decided = true;
  }
  return decided;
}

} // namespace rtsl::codegen
