//===- SsaRepair.h - one value with several definitions -------------------===//
#pragma once

#include "mlir/IR/Block.h"
#include "mlir/IR/Value.h"
#include "llvm/ADT/MapVector.h"

namespace rtsl::continuation {

/// New definitions of one value, each in force from the beginning of a block.
using Redefinitions = llvm::MapVector<mlir::Block *, mlir::Value>;

/// Makes each use of `value` read the definition that reaches it: `value` itself or one of
/// `redefinitions`, through block arguments where several meet. A use in a block that has a
/// redefinition reads that one. `value` must dominate all blocks with redefinitions.
void repairSsa(mlir::Value value, const Redefinitions &redefinitions);

} // namespace rtsl::continuation
