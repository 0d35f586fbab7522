//===- ConstantFold.h - the value of a constant expression ----------------===//
//
// Folding follows the rules of docs/language.md bit for bit: single precision, integers that wrap,
// division by zero that gives zero, minima that prefer their first operand. What a target may
// compute differently from the host is not folded here.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "sema/typed/TypedAst.h"

#include <cmath>
#include <map>
#include <optional>

namespace rtsl {

/// The value of `expr` if it is a constant expression. Otherwise none, and `obstacle` (if not null)
/// is set to the innermost part that is not constant.
std::optional<typed::Constant> evaluate(const typed::Expr &expr,
                                        const typed::Expr **obstacle = nullptr);

/// The value of `expr` if it follows from the known values of some of its parts.
std::optional<typed::Constant>
evaluate(const typed::Expr &expr, const std::map<const typed::Expr *, typed::Constant> &parts);

/// Is `expr` constant, whether or not its value is known here? The values of colors and of a few
/// functions are known only to the code generator. If not, `obstacle` is set to the innermost part
/// that is not constant.
bool isConstantExpression(const typed::Expr &expr, const typed::Expr **obstacle);

/// The value of a constant int or uint expression.
std::optional<std::int64_t> evaluateInteger(const typed::Expr &expr,
                                            const typed::Expr **obstacle = nullptr);

/// The value of a built-in function with constant arguments; none if it is not folded.
std::optional<typed::Constant> evaluateBuiltin(const typed::BuiltinExpr &call,
                                               const std::vector<typed::Constant> &args);

/// Conversion of a scalar: float to integer truncates and saturates, NaN gives 0.
typed::Constant::Scalar convertScalar(typed::Constant::Scalar value, TypeKind from, TypeKind to);

inline typed::Constant::Scalar makeFloat(float value) {
  typed::Constant::Scalar scalar;
  scalar.f = value;
  return scalar;
}
inline typed::Constant::Scalar makeUInt(std::uint32_t value) {
  typed::Constant::Scalar scalar;
  scalar.u = value;
  return scalar;
}
inline typed::Constant::Scalar makeInt(std::int32_t value) {
  typed::Constant::Scalar scalar;
  scalar.i = value;
  return scalar;
}
inline typed::Constant::Scalar makeBool(bool value) {
  typed::Constant::Scalar scalar;
  scalar.u = 0;
  scalar.b = value;
  return scalar;
}

} // namespace rtsl
