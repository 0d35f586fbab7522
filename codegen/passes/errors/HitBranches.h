//===- HitBranches.h - branches that a reported hit has decided -----------===//
//
//   cond_br %inside, ^hit, ^miss     ==>     br ^hit
//
// In a function that runs after `intersect` has reported a hit, a branch to code that reports none
// was not taken. So the conditions of a hit, such as whether a point is in a polygon, are not
// evaluated again; only what they decide about t is.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "llvm/ADT/SetVector.h"

namespace rtsl {

/// Removes these branches from a function of level 2, and what only they depend on. A branch
/// remains if a hit may have come before it, or if it may run again.
void takeBranchesToHits(mlir::func::FuncOp intersect);

/// The blocks that come directly or indirectly after one of these. A block that comes after itself
/// is in a loop.
llvm::SetVector<mlir::Block *> blocksAfter(llvm::ArrayRef<mlir::Block *> starts);

} // namespace rtsl
