//===- Attributes.h - discardable attributes of the dialect, typed --------===//
//
//   ir::attr::frameSize.set(function, builder.getI32IntegerAttr(bytes));
//   if (mlir::IntegerAttr size = ir::attr::frameSize.of(state)) ...
//
// Attributes.def explains each of them, and the verifier and these constants follow from it.
// TableGen can declare such attributes, too (`discardableAttrs` of a dialect), but a declaration is
// only a class and a name: it has no place for the operations that may have the attribute or for a
// description, so the verifier and the documentation would need a second table with the same
// names. What it generates is a class with a member for the interned name, which has to be made
// from a context, or got from the dialect, wherever an attribute is read or set.
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

#define RTSL_ATTRIBUTE(Constant, Word, Kind, On, Meaning)                                          \
  inline constexpr DiscardableAttribute<mlir::Kind##Attr> Constant = {"rtsl." Word};
#include "codegen/ir/Attributes.def"

} // namespace attr

} // namespace rtsl::ir

#endif
