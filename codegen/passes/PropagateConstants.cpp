//===- PropagateConstants.cpp - constants across branches and loops -------===//
#include "codegen/passes/PropagateConstants.h"

#include "codegen/ir/IncomingEdges.h"

#include "mlir/Analysis/DataFlow/ConstantPropagationAnalysis.h"
#include "mlir/Analysis/DataFlow/DeadCodeAnalysis.h"
#include "mlir/Analysis/DataFlowFramework.h"
#include "mlir/Dialect/ControlFlow/IR/ControlFlowOps.h"
#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "mlir/Interfaces/SideEffectInterfaces.h"
#include "mlir/Pass/Pass.h"
#include "mlir/Transforms/FoldUtils.h"

#include "llvm/ADT/SmallPtrSet.h"

#include <algorithm>

namespace rtsl::codegen {

namespace dataflow = mlir::dataflow;

namespace {

/// MLIR's analysis folds operations whose operands are constants as far as is known at that point,
/// and undoes in-place changes only if the fold returns no result. `vector.extract` with an index
/// that is assumed constant gets it as an attribute and then also returns a result: MLIR 22 keeps
/// the index even if it turns out not to be constant
/// (https://github.com/llvm/llvm-project/pull/213933). So here every change is undone.
class ConstantPropagation : public dataflow::SparseConstantPropagation {
public:
  using SparseConstantPropagation::SparseConstantPropagation;
  using Value = dataflow::Lattice<dataflow::ConstantValue>;

  mlir::LogicalResult visitOperation(mlir::Operation *op, llvm::ArrayRef<const Value *> operands,
                                     llvm::ArrayRef<Value *> results) override {
    const llvm::SmallVector<mlir::Value, 4> operandsBefore(op->getOperands());
    const mlir::DictionaryAttr attributesBefore = op->getAttrDictionary();
    const mlir::LogicalResult visited =
        SparseConstantPropagation::visitOperation(op, operands, results);
    if (!llvm::equal(op->getOperands(), operandsBefore))
      op->setOperands(operandsBefore);
    if (op->getAttrDictionary() != attributesBefore)
      op->setAttrs(attributesBefore);
    return visited;
  }
};

/// The most edges that one block may have while constants are propagated.
constexpr std::size_t mostEdges = 32;

/// The analysis visits all edges to a block whenever one of them becomes executable. Where there
/// are thousands, as from the cases of a switch, they are joined in steps; simplification removes
/// these blocks.
void joinInSteps(mlir::Block &join) {
  llvm::SmallVector<ir::Edge> edges;
  while (true) {
    edges.clear();
    ir::forEachEdgeInto(join, [&](ir::Edge edge) { edges.push_back(edge); });
    if (edges.size() <= mostEdges || !llvm::all_of(edges, [](ir::Edge edge) {
          return llvm::isa<mlir::cf::BranchOp, mlir::cf::CondBranchOp, mlir::cf::SwitchOp>(
              edge.terminator);
        }))
      return;
    const mlir::Location location = join.front().getLoc();
    for (auto rest = llvm::ArrayRef(edges); !rest.empty();
         rest = rest.drop_front(std::min(rest.size(), mostEdges))) {
      auto *step = new mlir::Block;
      join.getParent()->getBlocks().insert(join.getIterator(), step);
      for (mlir::BlockArgument argument : join.getArguments())
        step->addArgument(argument.getType(), argument.getLoc());
      mlir::OpBuilder builder = mlir::OpBuilder::atBlockEnd(step);
      mlir::cf::BranchOp::create(builder, location, &join, step->getArguments());
      for (ir::Edge edge : rest.take_front(std::min(rest.size(), mostEdges)))
        edge.terminator->setSuccessor(step, edge.successor);
    }
  }
}

/// Blocks are in the order of the source, so only loops lead back.
bool hasLoop(mlir::Region &body) {
  llvm::SmallPtrSet<mlir::Block *, 16> before;
  for (mlir::Block &block : body) {
    before.insert(&block);
    if (llvm::any_of(block.getSuccessors(),
                     [&](mlir::Block *next) { return before.contains(next); }))
      return true;
  }
  return false;
}

struct PropagateConstants
    : mlir::PassWrapper<PropagateConstants, mlir::OperationPass<mlir::func::FuncOp>> {
  MLIR_DEFINE_EXPLICIT_INTERNAL_INLINE_TYPE_ID(PropagateConstants)
  explicit PropagateConstants(bool inLoops) : inLoops(inLoops) {}
  llvm::StringRef getArgument() const override { return "rtsl-propagate-constants"; }
  llvm::StringRef getDescription() const override {
    return "propagates constants through branches and loops";
  }

  void runOnOperation() override {
    mlir::func::FuncOp function = getOperation();
    if (function.isExternal() || (inLoops && !hasLoop(function.getBody())))
      return;
    llvm::SmallVector<mlir::Block *> joins;
    for (mlir::Block &block : function.getBody())
      if (llvm::range_size(block.getPredecessors()) > mostEdges)
        joins.push_back(&block);
    for (mlir::Block *join : joins)
      joinInSteps(*join);
    mlir::DataFlowSolver solver;
    solver.load<dataflow::DeadCodeAnalysis>();
    solver.load<ConstantPropagation>();
    if (mlir::failed(solver.initializeAndRun(function)))
      return signalPassFailure();

    mlir::OperationFolder constants(&getContext());
    auto replace = [&](mlir::Value value) {
      const auto *state = solver.lookupState<ConstantPropagation::Value>(value);
      if (value.use_empty() || !state || state->getValue().isUninitialized())
        return;
      const dataflow::ConstantValue &known = state->getValue();
      if (!known.getConstantValue())
        return;
      mlir::Value constant =
          constants.getOrCreateConstant(&function.getBody().front(), known.getConstantDialect(),
                                        known.getConstantValue(), value.getType());
      if (constant && constant != value)
        value.replaceAllUsesWith(constant);
    };
    for (mlir::Block &block : function.getBody()) {
      for (mlir::Operation &op : llvm::make_early_inc_range(block)) {
        for (mlir::Value result : op.getResults())
          replace(result);
        if (mlir::isOpTriviallyDead(&op))
          op.erase();
      }
      for (mlir::Value argument : block.getArguments())
        replace(argument);
    }
  }

private:
  bool inLoops;
};

} // namespace

std::unique_ptr<mlir::Pass> createPropagateConstantsPass(bool inLoops) {
  return std::make_unique<PropagateConstants>(inLoops);
}

} // namespace rtsl::codegen
