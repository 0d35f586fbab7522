//===- BaseAddress.h - from the address of an element to its variable -----===//
#pragma once

#include "codegen/ir/dialect/RtslOps.h"

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

/// The operation that defines the base address, or, for a part of a buffer's element, that of the
/// buffer; null if it is an argument.
inline mlir::Operation *variableOperation(mlir::Value address) {
  mlir::Operation *base = baseOperation(address);
  while (auto element = llvm::dyn_cast_or_null<BufferElementOp>(base))
    base = baseOperation(element.getBuffer());
  return base;
}

/// Whether the address is in an output buffer, which the launch changes. `address` has no value
/// that is constant for the launch then.
inline bool isInOutputBuffer(mlir::Value address) {
  auto element = llvm::dyn_cast_or_null<BufferElementOp>(baseOperation(address));
  return element &&
         llvm::cast<BufferType>(llvm::cast<PtrType>(element.getBuffer().getType()).getPointee())
             .getOutput();
}

} // namespace rtsl::ir
