//===- HideConstants.cpp - no folding before LLVM IR ----------------------===//
#include "codegen/lower/HideConstants.h"

#include "codegen/ir/Rtsl.h"

#include "mlir/Dialect/Arith/IR/Arith.h"

namespace rtsl::lowering {

namespace arith = mlir::arith;

static bool isFloat(mlir::Type type) {
  return mlir::getElementTypeOrSelf(type).isF32();
}

static void hideResult(mlir::Operation *op) {
  mlir::OpBuilder builder(op->getContext());
  builder.setInsertionPointAfter(op);
  mlir::Value result = op->getResult(0);
  auto hidden = ir::HideOp::create(builder, op->getLoc(), result.getType(), result);
  result.replaceAllUsesExcept(hidden.getResult(), hidden);
}

static void hideOperands(mlir::Operation *op) {
  mlir::OpBuilder builder(op);
  for (mlir::OpOperand &operand : op->getOpOperands())
    operand.set(ir::HideOp::create(builder, op->getLoc(), operand.get().getType(), operand.get()));
}

void hideConstants(mlir::ModuleOp module) {
  llvm::SmallVector<mlir::Operation *> sources, functions;
  module.walk([&](mlir::Operation *op) {
    if (llvm::isa<arith::ConstantOp, arith::BitcastOp, ir::LoadOp>(op) &&
        isFloat(op->getResult(0).getType()))
      sources.push_back(op);
    else if (llvm::isa<arith::SIToFPOp, arith::UIToFPOp, ir::ElementaryOp, ir::RefractOp>(op))
      functions.push_back(op); // of integers; also of variables that turn out to be zero
  });
  llvm::for_each(sources, hideResult);
  llvm::for_each(functions, hideOperands);
}

} // namespace rtsl::lowering
