//===- Literals.h - numbers, constants and their names -------------------===//
#pragma once

#include "codegen/cpp/functions/FunctionPart.h"

namespace rtsl::cpp {

/// The shortest literal that reads back as the same number.
Code floatLiteral(float value);
Code doubleLiteral(double value);

class Literals : FunctionPart {
public:
  using FunctionPart::FunctionPart;

  Code literal(const Type *type, const typed::Constant &constant, const std::string &spelling);
  Code scalarLiteral(const Type *type, typed::Constant::Scalar value, const std::string &spelling);
  /// An initialiser of a field or an element: a bool needs 32 bits there.
  Code inMemory(const Type *type, Code value);
  /// The constant (Variable or Member) that the author named where the tree has its value; null:
  /// none.
  const void *namedConstant(const typed::LiteralExpr &expr) const;
  /// Is it an array of numbers that are written out, which C++ can make at compile time?
  bool isTable(const typed::Expr &expr) const;
};

} // namespace rtsl::cpp
