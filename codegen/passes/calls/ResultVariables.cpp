#include "codegen/passes/calls/ResultVariables.h"

#include "codegen/ir/dialect/RtslOps.h"

#include "llvm/ADT/SmallPtrSet.h"

namespace rtsl::codegen {

using mlir::Block;
using mlir::func::CallOp;

/// Is the variable cleared on each path from the call to the call? At first it is zero.
static bool isClearedBetween(mlir::Value variable, CallOp call) {
  llvm::SmallPtrSet<Block *, 16> seen; // and those that clear it
  for (mlir::Operation *user : variable.getUsers())
    if (llvm::isa<ir::ClearOp>(user))
      seen.insert(user->getBlock());
  Block *start = call->getBlock();
  if (seen.contains(start))
    return true;
  llvm::SmallVector<Block *> pending(start->getSuccessors());
  while (!pending.empty()) {
    Block *block = pending.pop_back_val();
    if (block == start)
      return false;
    if (seen.insert(block).second)
      pending.append(block->succ_begin(), block->succ_end());
  }
  return true;
}

static bool isReadAfter(mlir::Operation *user, CallOp call, const mlir::DominanceInfo &dominance) {
  if (llvm::isa<ir::LoadOp>(user))
    return dominance.properlyDominates(call, user);
  return llvm::isa<ir::FieldOp, ir::ElementOp>(user) &&
         llvm::all_of(user->getUsers(),
                      [&](mlir::Operation *inner) { return isReadAfter(inner, call, dominance); });
}

bool isResult(mlir::Value variable, CallOp call, const mlir::DominanceInfo &dominance) {
  return llvm::isa_and_nonnull<ir::VarOp>(variable.getDefiningOp()) &&
         llvm::count(call.getOperands(), variable) == 1 && isClearedBetween(variable, call) &&
         llvm::all_of(variable.getUsers(), [&](mlir::Operation *user) {
           return user == call || isReadAfter(user, call, dominance) ||
                  (llvm::isa<ir::ClearOp>(user) && dominance.properlyDominates(user, call));
         });
}

} // namespace rtsl::codegen
