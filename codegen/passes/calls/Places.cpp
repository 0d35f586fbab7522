#include "codegen/passes/calls/Places.h"

#include "codegen/ir/Rays.h"
#include "codegen/passes/calls/FunctionEffects.h"

#include "llvm/ADT/SmallPtrSet.h"

namespace rtsl::codegen {

using mlir::Block;
using mlir::func::CallOp;
using mlir::func::FuncOp;

bool isSameWhereverCalled(CallOp call, FuncOp function, EffectsOfFunctions &effects) {
  const FunctionEffects &callee = effects.of(call), &caller = effects.of(function);
  return callee.onlyReads() && !caller.writesAny &&
         !(caller.writesArguments && effects.mayReceiveState(function) && !callee.reads.empty()) &&
         llvm::none_of(callee.reads,
                       [&](const auto &entry) { return caller.writes.contains(entry.getKey()); });
}

bool isAlwaysReached(llvm::ArrayRef<CallOp> calls, Block *from) {
  llvm::SmallPtrSet<Block *, 16> seen;
  llvm::SmallVector<Block *> pending(from->getSuccessors());
  if (pending.empty())
    return false;
  while (!pending.empty()) {
    Block *block = pending.pop_back_val();
    if (!seen.insert(block).second ||
        llvm::any_of(calls, [&](CallOp call) { return call->getBlock() == block; }))
      continue;
    if (block == from || block->hasNoSuccessors())
      return false;
    pending.append(block->succ_begin(), block->succ_end());
  }
  return true;
}

/// In a block, from one operation to another one or the end.
static bool sendsRaysIn(mlir::Operation *first, mlir::Operation *end, bool countsLights,
                        EffectsOfFunctions &effects) {
  for (mlir::Operation *op = first; op && op != end; op = op->getNextNode()) {
    if (countsLights ? ir::sendsRays(op) : ir::isTrace(op))
      return true;
    if (auto call = llvm::dyn_cast<CallOp>(op)) {
      const FunctionEffects &callee = effects.of(call);
      if (countsLights ? callee.sendsRays : callee.traces)
        return true;
    }
  }
  return false;
}

bool sendsRaysBetween(mlir::Operation *place, CallOp call, EffectsOfFunctions &effects) {
  const bool countsLights = !effects.of(call).isCostly();
  const auto sendsIn = [&](mlir::Operation *first, mlir::Operation *end) {
    return sendsRaysIn(first, end, countsLights, effects);
  };
  Block *from = place->getBlock(), *to = call->getBlock();
  if (from == to)
    return sendsIn(place, call);
  if (sendsIn(place, nullptr) || sendsIn(&to->front(), call))
    return true;
  // Every block on a path back from the call is dominated by `from`.
  llvm::SmallPtrSet<Block *, 16> seen = {from};
  llvm::SmallVector<Block *> pending(to->getPredecessors());
  while (!pending.empty()) {
    Block *block = pending.pop_back_val();
    if (!seen.insert(block).second)
      continue;
    if (sendsIn(&block->front(), nullptr))
      return true;
    pending.append(block->pred_begin(), block->pred_end());
  }
  return false;
}

} // namespace rtsl::codegen
