//===- InsertSuspends.cpp - end blocks at their traces --------------------===//
//
//   ^a:                                     ^a:
//     before                                  before
//     %c = rtsl.trace %o, %d      ==>         rtsl.suspend %o, %d, ^resume
//     after                                 ^resume:
//                                             %c = rtsl.trace_result
//                                             after
//
//===----------------------------------------------------------------------===//
#include "codegen/passes/continuation/Steps.h"

#include "mlir/IR/PatternMatch.h"
#include "mlir/Transforms/RegionUtils.h"

namespace rtsl::continuation {

llvm::SmallVector<ir::SuspendOp> suspendsOf(FuncOp function) {
  llvm::SmallVector<ir::SuspendOp> suspends;
  for (mlir::Block &block : function.getBody())
    if (!block.empty())
      if (auto suspend = llvm::dyn_cast<ir::SuspendOp>(block.back()))
        suspends.push_back(suspend);
  return suspends;
}

mlir::Value objectOf(FuncOp function) {
  if (function.isExternal() || function.getNumArguments() == 0)
    return {};
  mlir::Value first = function.getArgument(0);
  return llvm::isa<ir::RefType>(first.getType()) ? first : mlir::Value();
}

void insertSuspends(FuncOp function) {
  if (function.isExternal())
    return;
  mlir::IRRewriter rewriter(function.getContext());
  (void)mlir::eraseUnreachableBlocks(rewriter, function->getRegions());

  llvm::SmallVector<ir::TraceOp> traces;
  function.walk([&](ir::TraceOp trace) { traces.push_back(trace); });
  for (ir::TraceOp trace : traces) {
    mlir::Block *block = trace->getBlock();
    mlir::Block *resume = block->splitBlock(trace->getNextNode());
    mlir::OpBuilder builder = mlir::OpBuilder::atBlockEnd(block);
    ir::SuspendOp::create(builder, trace.getLoc(), trace.getOrigin(), trace.getDirection(),
                          mlir::ValueRange{}, builder.getArrayAttr({}), resume);
    builder.setInsertionPointToStart(resume);
    auto result = ir::TraceResultOp::create(builder, trace.getLoc(), trace.getType());
    trace.replaceAllUsesWith(result.getResult());
    trace.erase();
  }
}

} // namespace rtsl::continuation
