//===- SinkLoads.cpp - move loads of the frame to their uses --------------===//
//
//   ^entry:                              ^entry:
//     %c = rtsl.trace_result               %c = rtsl.trace_result
//     %w = rtsl.frame_load "w"[0]          cond_br %again, ^a, ^b
//     cond_br %again, ^a, ^b       ==>   ^a:
//   ^a:                                    %w = rtsl.frame_load "w"[0]
//     use %w                               use %w
//
// Loads of the frame and recomputed values are at the beginning of a state. They move down to the
// block that dominates all their uses, but never into a loop.
//
//===----------------------------------------------------------------------===//
#include "codegen/ir/Attributes.h"
#include "codegen/passes/continuation/states/Steps.h"

#include "mlir/Analysis/CFGLoopInfo.h"
#include "mlir/IR/Dominance.h"
#include "mlir/Interfaces/SideEffectInterfaces.h"

namespace rtsl::continuation {

/// May the operation move to its uses? Nothing in between changes its result.
static bool mayMove(mlir::Operation &op) {
  // Stores are at the ends of states, after the beginning of any block; objects are written
  // anywhere.
  if (llvm::isa<ir::FrameLoadOp>(op))
    return !ir::attr::shared.isOn(&op);
  if (auto load = llvm::dyn_cast<ir::LoadOp>(op)) // constant for a launch
    return llvm::isa_and_nonnull<ir::MemberOp>(load.getAddress().getDefiningOp());
  return !op.hasTrait<mlir::OpTrait::IsTerminator>() && mlir::isMemoryEffectFree(&op);
}

void sinkLoads(FuncOp state) {
  if (state.isExternal() || state.getBody().hasOneBlock())
    return;
  mlir::DominanceInfo dominance(state);
  mlir::CFGLoopInfo loops(dominance.getDomTree(&state.getBody()));
  mlir::Block &entry = state.getBody().front();

  for (mlir::Operation &op : llvm::make_early_inc_range(llvm::reverse(entry))) {
    if (!mayMove(op) || op.use_empty())
      continue;
    mlir::Block *target = nullptr;
    for (mlir::Operation *user : op.getUsers())
      target = target ? dominance.findNearestCommonDominator(target, user->getBlock())
                      : user->getBlock();
    while (target != &entry && loops.getLoopDepth(target) != 0)
      target = dominance.getNode(target)->getIDom()->getBlock();
    if (target != &entry)
      op.moveBefore(&target->front());
  }
}

} // namespace rtsl::continuation
