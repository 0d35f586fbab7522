//===- Expressions.h - expressions, in the order of RTSL -----------------===//
//
// RTSL evaluates operands from left to right, C++ in any order. Where the order could be noticed,
// operands go into variables, in statements before the one that is being made.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/cpp/functions/FunctionPart.h"

namespace rtsl::cpp {

class Expressions : FunctionPart {
public:
  using FunctionPart::FunctionPart;

  Code expr(const typed::Expr &expr);
  /// The expression as an operand of an operator with this precedence. The author's own parentheses
  /// are kept.
  Code operand(const typed::Expr &expr, Binding atLeast);
  Code argument(const typed::Expr &expr) { return operand(expr, Binding::Assignment); }
  /// Operands whose order C++ does not define: where it could be noticed, they go into variables.
  std::vector<Code> operands(const std::vector<const typed::Expr *> &exprs, Binding atLeast);
  std::vector<Code> arguments(const std::vector<typed::ExprPtr> &exprs);
  /// An expression that may be evaluated not at all, or several times: no statement can be put
  /// before it.
  Code apart(const typed::Expr &expr, Binding atLeast);
  /// An initialiser outside of functions.
  Code initialiser(const typed::Expr &expr);

private:
  Code lowered(const typed::Expr &expr);
  Code conditional(const typed::ConditionalExpr &expr);
};

/// Does it lie in a record, a struct or an array, where bools have 32 bits?
bool isInMemory(const typed::Expr &expr);

} // namespace rtsl::cpp
