//===- RtslOpt.cpp - runs single passes on IR -----------------------------===//
//
// What mlir-opt is for MLIR's dialects: `rtsl-opt --rtsl-to-cf --mem2reg FILE` reads IR, runs
// passes in the order of the command line, verifies after each and prints IR.
//
//===----------------------------------------------------------------------===//
#include "codegen/emit/patterns/ConvertToLlvm.h"
#include "codegen/passes/Pipeline.h"
#include "codegen/passes/errors/BoundHitError.h"
#include "codegen/passes/restructure/Restructure.h"
#include "tools/rtsl-opt/ContinuationPasses.h"

#include "mlir/Dialect/Arith/IR/Arith.h"
#include "mlir/Dialect/ControlFlow/IR/ControlFlow.h"
#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "mlir/Dialect/Math/IR/Math.h"
#include "mlir/Dialect/Vector/IR/VectorOps.h"
#include "mlir/Tools/mlir-opt/MlirOptMain.h"
#include "mlir/Transforms/Passes.h"

int main(int argc, char **argv) {
  mlir::DialectRegistry registry;
  registry.insert<mlir::arith::ArithDialect, mlir::cf::ControlFlowDialect, mlir::func::FuncDialect,
                  mlir::math::MathDialect, mlir::vector::VectorDialect>();
  rtsl::codegen::registerPassDependencies(registry);
  rtsl::codegen::registerPasses();
  rtsl::registerContinuationPasses();
  rtsl::registerRestructurePass();
  rtsl::registerBoundHitErrorPass();
  rtsl::codegen::registerLlvmPasses();
  mlir::registerTransformsPasses();
  return mlir::asMainReturnCode(
      mlir::MlirOptMain(argc, argv, "runs passes on the IR of the shading language\n", registry));
}
