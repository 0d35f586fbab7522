//===- PropagateConstants.cpp - what is constant whichever way control comes ===//
#include "codegen/passes/PropagateConstants.h"

#include "mlir/Analysis/DataFlow/ConstantPropagationAnalysis.h"
#include "mlir/Analysis/DataFlow/DeadCodeAnalysis.h"
#include "mlir/Analysis/DataFlowFramework.h"
#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "mlir/Interfaces/SideEffectInterfaces.h"
#include "mlir/Pass/Pass.h"
#include "mlir/Transforms/FoldUtils.h"

namespace rtsl::codegen {

namespace dataflow = mlir::dataflow;

namespace {

/// MLIR's analysis folds operations with operands that are constant as far as it knows yet, and takes back what folding
/// has changed in the operation only if it gives no result. `vector.extract` with an index that is taken for constant gets
/// the index built in and then gives a result: MLIR 22 leaves the index there although it is not constant after all
/// (https://github.com/llvm/llvm-project/pull/213933). So here everything is taken back.
class ConstantPropagation : public dataflow::SparseConstantPropagation {
public:
  using SparseConstantPropagation::SparseConstantPropagation;
  using Value = dataflow::Lattice<dataflow::ConstantValue>;

  mlir::LogicalResult visitOperation(mlir::Operation *op, llvm::ArrayRef<const Value *> operands,
                                     llvm::ArrayRef<Value *> results) override {
    const llvm::SmallVector<mlir::Value, 4> operandsBefore(op->getOperands());
    const mlir::DictionaryAttr attributesBefore = op->getAttrDictionary();
    const mlir::LogicalResult visited = SparseConstantPropagation::visitOperation(op, operands, results);
    if (!llvm::equal(op->getOperands(), operandsBefore))
      op->setOperands(operandsBefore);
    if (op->getAttrDictionary() != attributesBefore)
      op->setAttrs(attributesBefore);
    return visited;
  }
};

struct PropagateConstants : mlir::PassWrapper<PropagateConstants, mlir::OperationPass<mlir::func::FuncOp>> {
  MLIR_DEFINE_EXPLICIT_INTERNAL_INLINE_TYPE_ID(PropagateConstants)
  llvm::StringRef getArgument() const override { return "rtsl-propagate-constants"; }
  llvm::StringRef getDescription() const override { return "finds constants through branches and loops"; }

  void runOnOperation() override {
    mlir::func::FuncOp function = getOperation();
    if (function.isExternal())
      return;
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
          constants.getOrCreateConstant(&function.getBody().front(), known.getConstantDialect(), known.getConstantValue(),
                                        value.getType());
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
};

} // namespace

std::unique_ptr<mlir::Pass> createPropagateConstantsPass() {
  return std::make_unique<PropagateConstants>();
}

} // namespace rtsl::codegen
