//===- SsaRepair.h - one value with several definitions -------------------===//
#pragma once

#include "mlir/IR/Block.h"
#include "mlir/IR/Region.h"
#include "mlir/IR/Value.h"
#include "llvm/ADT/MapVector.h"
#include "llvm/ADT/SmallPtrSet.h"

namespace rtsl::continuation {

/// New definitions of one value, each valid from the beginning of a block.
using Redefinitions = llvm::MapVector<mlir::Block *, mlir::Value>;

/// The blocks of a function in reverse postorder, for many repairs: these change block arguments,
/// but no blocks or branches.
class BlockOrder {
public:
  explicit BlockOrder(mlir::Region &body);
  /// The reachable ones of `blocks`, in that order.
  llvm::SmallVector<mlir::Block *> sorted(const llvm::SmallPtrSetImpl<mlir::Block *> &blocks) const;

private:
  llvm::DenseMap<mlir::Block *, unsigned> numbers;
};

/// Makes each use of `value` read the definition that reaches it: `value` itself or one of
/// `redefinitions`, through block arguments where several meet. A use in a block that has a
/// redefinition reads that one. `value` must dominate all blocks with redefinitions.
void repairSsa(mlir::Value value, const Redefinitions &redefinitions, const BlockOrder &order);

} // namespace rtsl::continuation
