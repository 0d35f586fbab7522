//===- HoistVariables.cpp - variables to the entry of their function ------===//
#include "codegen/passes/variables/HoistVariables.h"

#include "codegen/ir/dialect/RtslOps.h"

#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "mlir/Pass/Pass.h"

namespace rtsl::codegen {

void hoistVariables(mlir::func::FuncOp function) {
  mlir::Block &entry = function.getBody().front();
  llvm::SmallVector<ir::VarOp> scattered;
  function.walk([&](ir::VarOp variable) {
    if (variable->getBlock() != &entry)
      scattered.push_back(variable);
  });

  mlir::OpBuilder builder(function.getContext());
  for (ir::VarOp variable : llvm::reverse(scattered)) {
    builder.setInsertionPointAfter(variable);
    ir::ClearOp::create(builder, variable.getLoc(), variable.getResult());
    variable->moveBefore(&entry, entry.begin());
  }
}

namespace {

struct HoistVariables : mlir::PassWrapper<HoistVariables, mlir::OperationPass<mlir::func::FuncOp>> {
  MLIR_DEFINE_EXPLICIT_INTERNAL_INLINE_TYPE_ID(HoistVariables)
  llvm::StringRef getArgument() const override { return "rtsl-hoist-vars"; }
  llvm::StringRef getDescription() const override {
    return "moves variables to the entry of their function";
  }

  void runOnOperation() override {
    if (!getOperation().isExternal())
      hoistVariables(getOperation());
  }
};

} // namespace

std::unique_ptr<mlir::Pass> createHoistVariablesPass() {
  return std::make_unique<HoistVariables>();
}

} // namespace rtsl::codegen
