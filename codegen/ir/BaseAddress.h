//===- BaseAddress.h - from the address of an element to its variable -----===//
#pragma once

#include "codegen/ir/RtslOps.h"

namespace rtsl::ir {

/// The address of the variable, member, state variable or argument that `address` is a part of:
/// without its path through fields and elements. The address of an element of a buffer is its own
/// base.
inline mlir::Value baseAddress(mlir::Value address) {
  while (llvm::isa_and_nonnull<FieldOp, ElementOp>(address.getDefiningOp()))
    address = address.getDefiningOp()->getOperand(0);
  return address;
}

/// The operation that defines the base address; null if it is an argument.
inline mlir::Operation *baseOperation(mlir::Value address) {
  return baseAddress(address).getDefiningOp();
}

} // namespace rtsl::ir
