//===- Term.h - formulas over typed expressions ---------------------------===//
//
// Operators and functions that build expressions, so that the rules of derivation
// (language/Derivatives.def) are written as formulas. A term that is known to be zero has no
// expression, and formulas with it become simpler: `cos(x) * dx` of a zero dx is zero.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "sema/typed/TypedAst.h"

namespace rtsl::derive {

class Term {
public:
  Term() = default; // zero
  Term(typed::ExprPtr expr, TypeContext &types) : owned(std::move(expr)), context(&types) {}
  Term(const Term &other);
  Term(Term &&) = default;
  Term &operator=(const Term &other);
  Term &operator=(Term &&) = default;

  bool isZero() const { return !owned; }
  const typed::Expr &expr() const { return *owned; }
  const Type *type() const { return owned->type; }
  TypeContext &types() const { return *context; }
  /// Takes the expression out; null if it is zero.
  typed::ExprPtr take() { return std::move(owned); }

private:
  typed::ExprPtr owned;
  TypeContext *context = nullptr;
};

/// An expression with value 0 in all its numbers.
typed::ExprPtr zero(const Type *type, SourceRange range);
/// May values of the type have a derivative? Floats, and what consists of numbers with a float
/// among them.
bool isDifferentiable(const Type *type);

/// The term with the shape of another type: a scalar as all components.
Term fitted(Term term, const Type *type);

Term operator-(const Term &a);
Term operator+(const Term &a, const Term &b);
Term operator-(const Term &a, const Term &b);
Term operator*(const Term &a, const Term &b);
Term operator/(const Term &a, const Term &b);
Term operator+(const Term &a, float b);
Term operator-(const Term &a, float b);
Term operator-(float a, const Term &b);
Term operator*(float a, const Term &b);

/// A call of a built-in function; its type is that of the first argument.
Term call(typed::Builtin function, const std::vector<Term> &args);
/// The same, with the given type.
Term call(typed::Builtin function, const std::vector<Term> &args, const Type *type);
/// A constant with the source range of `at`.
Term constant(float value, const Term &at);
/// A component of a vector.
Term component(const Term &vector, std::uint32_t index);
/// `condition ? a : b`, by component if it is a vector of bool; either may be zero, in the shape of
/// `type`.
Term select(const Term &condition, const Term &a, const Term &b, const Type *type);
/// a < b, by component.
Term less(const Term &a, const Term &b);
/// An int as a float.
Term toFloat(const Term &a);

} // namespace rtsl::derive
