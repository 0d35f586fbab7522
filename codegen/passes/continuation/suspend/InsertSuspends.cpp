//===- InsertSuspends.cpp - end blocks at their traces --------------------===//
//
//   ^a:                                     ^a:
//     before                                  before
//     %c = rtsl.trace %o, %d      ==>         rtsl.suspend %o, %d, ^resume
//     after                                 ^resume:
//                                             %c = rtsl.trace_result
//                                             after
//
// A ray with a payload is prepared before the suspend, which then names none:
//
//     rtsl.trace_payload %o, %d ...           rtsl.spawn_payload %o, %d ...
//     after                           ==>     rtsl.suspend ^resume
//                                           ^resume:
//                                             rtsl.trace_returned
//                                             after
//
// A call of a function that has its own frame is handled in the same way:
//
//     %r = call @f(%v) {rtsl.framed}          rtsl.enter @f(%v)
//     after                           ==>     rtsl.suspend ^resume
//                                           ^resume:
//                                             %r = rtsl.call_returned
//                                             after
//
//===----------------------------------------------------------------------===//
#include "codegen/ir/Rays.h"
#include "codegen/passes/continuation/calls/Steps.h"
#include "codegen/passes/continuation/common/Recompute.h"
#include "codegen/passes/continuation/suspend/Steps.h"

#include "mlir/IR/PatternMatch.h"
#include "mlir/Transforms/RegionUtils.h"

namespace rtsl::continuation {

/// Prepares the call; its results are inserted at `builder`.
static void suspendAtCall(mlir::func::CallOp call, mlir::OpBuilder builder,
                          const WriteSummary &summary) {
  const bool hasObject =
      call.getNumOperands() != 0 && llvm::isa<ir::RefType>(call.getOperand(0).getType());
  const CallLayout layout = layoutCall(call.getOperands().drop_front(hasObject ? 1 : 0).getTypes(),
                                       call.getResultTypes());
  auto returned =
      ir::CallReturnedOp::create(builder, call.getLoc(), call.getResultTypes(), layout.results);
  call.replaceAllUsesWith(returned.getResults());
  builder.setInsertionPoint(call);
  const StateWrites writes = summary.of(call);
  mlir::ArrayAttr names;
  if (!writes.any) {
    llvm::SmallVector<llvm::StringRef> sorted(writes.names.keys());
    llvm::sort(sorted);
    names = builder.getStrArrayAttr(sorted);
  }
  ir::EnterOp::create(builder, call.getLoc(), call.getCallee(), call.getOperands(),
                      layout.arguments, names, /*resume=*/nullptr);
  call.erase();
}

/// ^a: x; trace; y      ==>      ^a: x; suspend ^b   ^b: y. Returns a builder at the beginning of
/// ^b.
static mlir::OpBuilder suspendAt(mlir::Operation *trace, mlir::Value origin,
                                 mlir::Value direction) {
  mlir::Block *block = trace->getBlock();
  mlir::Block *resume = block->splitBlock(trace->getNextNode());
  mlir::OpBuilder builder = mlir::OpBuilder::atBlockEnd(block);
  ir::SuspendOp::create(builder, trace->getLoc(), origin, direction, mlir::ValueRange{},
                        builder.getArrayAttr({}), resume);
  builder.setInsertionPointToStart(resume);
  return builder;
}

void insertSuspends(FuncOp function, const WriteSummary &summary) {
  if (function.isExternal())
    return;
  mlir::IRRewriter rewriter(function.getContext());
  (void)mlir::eraseUnreachableBlocks(rewriter, function->getRegions());

  llvm::SmallVector<mlir::Operation *> traces;
  function.walk([&](mlir::Operation *op) {
    if (ir::isTrace(op) || (llvm::isa<mlir::func::CallOp>(op) && isFramed(op)))
      traces.push_back(op);
  });
  for (mlir::Operation *op : traces) {
    if (auto trace = llvm::dyn_cast<ir::TraceOp>(op)) {
      mlir::OpBuilder builder = suspendAt(trace, trace.getOrigin(), trace.getDirection());
      auto result = ir::TraceResultOp::create(builder, trace.getLoc(), trace.getType());
      trace.replaceAllUsesWith(result.getResult());
      trace.erase();
      continue;
    }
    if (auto call = llvm::dyn_cast<mlir::func::CallOp>(op)) {
      suspendAtCall(call, suspendAt(call, {}, {}), summary);
      continue;
    }
    auto trace = llvm::cast<ir::TracePayloadOp>(op);
    mlir::OpBuilder builder = suspendAt(trace, {}, {});
    ir::TraceReturnedOp::create(builder, trace.getLoc());
    builder.setInsertionPoint(trace);
    ir::SpawnPayloadOp::create(builder, trace.getLoc(), trace.getOrigin(), trace.getDirection(),
                               trace.getTmin(), trace.getTmax(), trace.getPayload(),
                               trace.getRoot(), trace.getMask(), trace.getTime(),
                               trace.getRayTypeAttr(), trace.getHowAttr(), /*last=*/nullptr);
    trace.erase();
  }
}

void insertSuspends(FuncOp function) {
  insertSuspends(function, WriteSummary(function->getParentOfType<mlir::ModuleOp>()));
}

} // namespace rtsl::continuation
