//===- Simplify.cpp - folding over `cf` -----------------------------------===//
#include "codegen/passes/Simplify.h"

#include "codegen/ir/IncomingEdges.h"
#include "codegen/passes/FoldFma.h"
#include "codegen/passes/ShareExpressions.h"

#include "mlir/Dialect/ControlFlow/IR/ControlFlowOps.h"
#include "mlir/IR/Dominance.h"
#include "mlir/IR/Matchers.h"
#include "mlir/IR/PatternMatch.h"
#include "mlir/Pass/Pass.h"
#include "mlir/Transforms/GreedyPatternRewriteDriver.h"
#include "mlir/Transforms/RegionUtils.h"

namespace rtsl::codegen {

namespace cf = mlir::cf;

Simplify::Simplify(mlir::MLIRContext *context) {
  mlir::RewritePatternSet all(context);
  llvm::StringRef branches = cf::ControlFlowDialect::getDialectNamespace();
  for (mlir::Dialect *dialect : context->getLoadedDialects())
    if (dialect->getNamespace() != branches)
      dialect->getCanonicalizationPatterns(all);
  for (mlir::RegisteredOperationName op : context->getRegisteredOperations())
    if (op.getDialectNamespace() != branches)
      op.getCanonicalizationPatterns(all, context);
  addFmaFolding(all);
  patterns = mlir::FrozenRewritePatternSet(std::move(all));
}

/// The only successor that a branch can take: of a branch on a constant, or one with one target;
/// nothing if there are several.
static std::optional<unsigned> onlySuccessor(mlir::Operation *terminator) {
  llvm::APInt value;
  if (auto branch = llvm::dyn_cast<cf::CondBranchOp>(terminator)) {
    if (mlir::matchPattern(branch.getCondition(), mlir::m_ConstantInt(&value)))
      return value.isZero() ? 1 : 0;
    if (branch.getTrueDest() == branch.getFalseDest() &&
        llvm::equal(branch.getTrueDestOperands(), branch.getFalseDestOperands()))
      return 0;
  }
  if (auto choice = llvm::dyn_cast<cf::SwitchOp>(terminator)) {
    if (!mlir::matchPattern(choice.getFlag(), mlir::m_ConstantInt(&value)))
      return std::nullopt;
    if (auto cases = choice.getCaseValues())
      for (auto [index, one] : llvm::enumerate(cases->getValues<llvm::APInt>()))
        if (one == value)
          return index + 1;
    return 0; // the default
  }
  return std::nullopt;
}

/// Replaces an argument that gets the same value on all edges by that value.
static bool dropSameArguments(mlir::Region &body) {
  bool changed = false;
  for (mlir::Block &block : llvm::drop_begin(body))
    for (unsigned i = block.getNumArguments(); i-- > 0;) {
      mlir::BlockArgument argument = block.getArgument(i);
      mlir::Value only;
      bool isOne = true;
      ir::forEachEdgeInto(block, [&](ir::Edge edge) {
        mlir::Value incoming = edge.passedTo(argument);
        if (incoming == argument)
          return;
        isOne &= incoming && (!only || only == incoming);
        only = incoming;
      });
      if (!isOne || !only)
        continue;
      argument.replaceAllUsesWith(only);
      ir::forEachEdgeInto(block, [&](ir::Edge edge) { edge.operands().erase(i); });
      block.eraseArgument(i);
      changed = true;
    }
  return changed;
}

static bool foldBranches(mlir::IRRewriter &rewriter, mlir::Region &body) {
  bool changed = false;
  for (mlir::Block &block : body) {
    mlir::Operation *terminator = block.getTerminator();
    std::optional<unsigned> only = onlySuccessor(terminator);
    if (!only)
      continue;
    auto branch = llvm::cast<mlir::BranchOpInterface>(terminator);
    llvm::SmallVector<mlir::Value> operands(
        branch.getSuccessorOperands(*only).getForwardedOperands());
    rewriter.setInsertionPoint(terminator);
    rewriter.replaceOpWithNewOp<cf::BranchOp>(terminator, terminator->getSuccessor(*only),
                                              operands);
    changed = true;
  }
  return changed;
}

/// ^a: x; br ^b(%v)   ^b(%p): br ^c(%p)   ==>     ^a: x; br ^c(%v)
static bool skipPassThrough(mlir::Region &body) {
  bool changed = false;
  for (mlir::Block &block : llvm::drop_begin(body)) {
    auto through = llvm::dyn_cast<cf::BranchOp>(block.front());
    if (!through || through.getDest() == &block)
      continue;
    auto usedElsewhere = [&](mlir::BlockArgument argument) {
      return llvm::any_of(argument.getUsers(),
                          [&](mlir::Operation *user) { return user != through; });
    };
    if (llvm::any_of(block.getArguments(), usedElsewhere) ||
        llvm::any_of(block.getPredecessors(), [](mlir::Block *predecessor) {
          return !llvm::isa<cf::BranchOp, cf::CondBranchOp, cf::SwitchOp>(
              predecessor->getTerminator());
        }))
      continue;
    ir::forEachEdgeInto(block, [&](ir::Edge edge) {
      llvm::SmallVector<mlir::Value> operands;
      for (mlir::Value operand : through.getDestOperands()) {
        auto argument = llvm::dyn_cast<mlir::BlockArgument>(operand);
        bool isOwn = argument && argument.getOwner() == &block;
        operands.push_back(isOwn ? edge.passedTo(argument) : operand);
      }
      edge.operands().getMutableForwardedOperands().assign(operands);
      edge.terminator->setSuccessor(through.getDest(), edge.successor);
      changed = true;
    });
  }
  return changed;
}

/// ^a: x; br ^b(%v)   ^b(%p): y     ==>     ^a: x; y        if that is the only edge to ^b
static bool mergeChains(mlir::IRRewriter &rewriter, mlir::Region &body) {
  bool changed = false;
  for (mlir::Block &block : body)
    while (auto branch = llvm::dyn_cast<cf::BranchOp>(block.getTerminator())) {
      mlir::Block *next = branch.getDest();
      if (next == &block || next->isEntryBlock() || !next->getSinglePredecessor())
        break;
      llvm::SmallVector<mlir::Value> operands(branch.getDestOperands());
      rewriter.eraseOp(branch);
      rewriter.mergeBlocks(next, &block, operands);
      changed = true;
    }
  return changed;
}

void Simplify::run(mlir::func::FuncOp function) const {
  mlir::IRRewriter rewriter(function.getContext());
  mlir::GreedyRewriteConfig config;
  config.setRegionSimplificationLevel(
      mlir::GreedySimplifyRegionLevel::Disabled); // done below, once per iteration
  bool changed = true;
  for (int round = 0; changed && round < 10;
       ++round) { // each iteration folds what the previous one exposed
    changed = false;
    (void)mlir::eraseUnreachableBlocks(rewriter, function->getRegions());
    (void)mlir::applyPatternsGreedily(function, patterns, config, &changed);
    changed |= mlir::succeeded(
        mlir::simplifyRegions(rewriter, function->getRegions(), /*mergeBlocks=*/false));
    bool folded = true;
    while (folded) {
      folded = foldBranches(rewriter, function.getBody());
      folded |= skipPassThrough(function.getBody());
      (void)mlir::eraseUnreachableBlocks(rewriter, function->getRegions());
      folded |= dropSameArguments(function.getBody());
      folded |= mergeChains(rewriter, function.getBody());
      changed |= folded;
    }
    if (round > 0 && !changed)
      break; // values unified in the previous iteration are unified already
    mlir::DominanceInfo dominance(function);
    changed |= shareExpressions(function, dominance);
  }
}

namespace {

struct SimplifyPass : mlir::PassWrapper<SimplifyPass, mlir::OperationPass<mlir::func::FuncOp>> {
  MLIR_DEFINE_EXPLICIT_INTERNAL_INLINE_TYPE_ID(SimplifyPass)
  llvm::StringRef getArgument() const override { return "rtsl-simplify"; }
  llvm::StringRef getDescription() const override { return "folds, and erases dead code"; }
  mlir::LogicalResult initialize(mlir::MLIRContext *context) override {
    simplify = std::make_shared<Simplify>(context);
    return mlir::success();
  }
  void runOnOperation() override {
    if (!getOperation().isExternal())
      simplify->run(getOperation());
  }
  std::shared_ptr<const Simplify> simplify;
};

} // namespace

std::unique_ptr<mlir::Pass> createSimplifyPass() {
  return std::make_unique<SimplifyPass>();
}

} // namespace rtsl::codegen
