//===- Attributes.h - discardable attributes of the dialect, typed --------===//
//
//   ir::attr::frameSize.set(function, builder.getI32IntegerAttr(bytes));
//   if (mlir::IntegerAttr size = ir::attr::frameSize.of(state)) ...
//
// dialect/RtslDiscardableAttributes.td declares and explains them.
//
//===----------------------------------------------------------------------===//
#ifndef RTSL_CODEGEN_IR_ATTRIBUTES_H // not `#pragma once`: see Precompiled.h
#define RTSL_CODEGEN_IR_ATTRIBUTES_H

#include "mlir/IR/BuiltinAttributes.h"
#include "mlir/IR/Operation.h"

#include <type_traits>

namespace rtsl::ir {

/// A discardable attribute with a value of class `Value`.
template <typename Value>
struct DiscardableAttribute {
  llvm::StringLiteral name; // with `rtsl.`

  bool isOn(mlir::Operation *op) const { return op->hasAttr(name); }
  /// Its value; null if the operation does not have it.
  Value of(mlir::Operation *op) const { return op->getAttrOfType<Value>(name); }
  void set(mlir::Operation *op, Value value) const { op->setAttr(name, value); }
  /// For an attribute that takes no value.
  template <typename Unit = Value>
  std::enable_if_t<std::is_same_v<Unit, mlir::UnitAttr>> set(mlir::Operation *op) const {
    op->setAttr(name, mlir::UnitAttr::get(op->getContext()));
  }
  void removeFrom(mlir::Operation *op) const { op->removeAttr(name); }
};

namespace attr {

#define RTSL_ATTRIBUTE(Constant, Word, Class, Rule, Operations)                                    \
  inline constexpr DiscardableAttribute<mlir::Class> Constant = {"rtsl." Word};
#include "codegen/ir/dialect/RtslDiscardableAttributes.inc"

} // namespace attr

} // namespace rtsl::ir

#endif
