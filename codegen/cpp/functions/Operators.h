//===- Operators.h - operators -------------------------------------------===//
//
// An operator of RTSL is one of C++ where that is always defined and means the same. An int may
// overflow, a divisor may be zero, a matrix product adds in RTSL's order: those are functions of
// the runtime header, unless the operands show that nothing can happen.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/cpp/functions/FunctionPart.h"

namespace rtsl::cpp {

class Operators : FunctionPart {
public:
  using FunctionPart::FunctionPart;

  Code unary(const typed::UnaryExpr &expr);
  Code binary(ast::BinaryOp op, const typed::Expr &left, const typed::Expr &right);
  /// The operator of C++; nothing: there is none that means the same.
  std::optional<Operator> plainOperator(ast::BinaryOp op, const typed::Expr &left,
                                        const typed::Expr &right);
  /// The function of the runtime header for the operator.
  std::string functionFor(ast::BinaryOp op, const typed::Expr &left, const typed::Expr &right);

private:
  /// Operands of an operation that takes any number of them.
  void appendOperands(ast::BinaryOp op, const typed::Expr &expr,
                      std::vector<const typed::Expr *> &into);
  void compareStructs(const Type *type);
};

} // namespace rtsl::cpp
