//===- Number.h - known values with operators -----------------------------===//
//
// What formulas (language/formulas) are made of, for constants: a scalar or a vector of float, int
// or bool whose components are known. Floats are computed in single precision, one rounding an
// operation; ints wrap.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "language/formulas/Operations.h"
#include "sema/typed/TypedAst.h"

#include <array>
#include <initializer_list>
#include <optional>
#include <vector>

namespace rtsl::fold {

class Number {
public:
  using Scalar = typed::Constant::Scalar;
  enum class Kind : std::uint8_t { Float, Int, Bool };
  static constexpr unsigned maxWidth = 16; // of a color

  Number() = default;
  /// `width` 0: a scalar.
  Number(Kind kind, unsigned width) : kind(kind), components(width) {}
  /// The `type.componentCount()` scalars from `first` on; of a scalar or vector type.
  Number(const Type &type, const Scalar *first);
  /// The scalars, as a constant of the language has them.
  void appendTo(typed::Constant &constant) const;

  unsigned width() const { return components; }
  unsigned count() const { return components == 0 ? 1 : components; }
  bool isFloat() const { return kind == Kind::Float; }
  Kind scalarKind() const { return kind; }
  /// Component; a scalar is each of its components.
  Scalar &at(unsigned i) { return scalars[components == 0 ? 0 : i]; }
  const Scalar &at(unsigned i) const { return scalars[components == 0 ? 0 : i]; }

  Number like(double constant) const;
  Number real(float constant) const;
  Number integer(std::int32_t constant) const;
  Number constants(const std::vector<double> &values) const;
  static Number vector(const std::vector<Number> &components);
  Number operator[](unsigned component) const;
  Number shuffle(std::initializer_list<int> indices) const;

  Number bits() const { return as(Kind::Int); }
  Number asFloat() const { return as(Kind::Float); }

  class Variable;

private:
  Number as(Kind other) const;

  Kind kind = Kind::Float;
  unsigned components = 0;
  std::array<Scalar, maxWidth> scalars = {};
};

using Columns = formulas::Columns<Number>;

/// The columns of a matrix, or the scalar or vector alone.
Columns columnsOf(const Type &type, const typed::Constant &constant);
typed::Constant toConstant(const Columns &value);

Number operator+(Number a, Number b);
Number operator-(Number a, Number b);
Number operator*(Number a, Number b);
Number operator/(Number a, Number b);
Number operator-(Number a);
Number operator&(Number a, Number b);
Number operator|(Number a, Number b);
Number operator^(Number a, Number b);
Number operator!(Number a);
Number shiftLeft(Number a, Number count);
Number shiftRight(Number a, Number count);
Number shiftRightSigned(Number a, Number count);

Number less(Number a, Number b);
Number lessEqual(Number a, Number b);
Number equal(Number a, Number b);
Number notEqual(Number a, Number b);
Number lessUnsigned(Number a, Number b);
Number select(Number condition, Number a, Number b);

Number fma(Number a, Number b, Number c);
Number sqrt(Number a);
Number floor(Number a);
Number ceil(Number a);
Number trunc(Number a);
Number roundEven(Number a);
Number abs(Number a);

Number toInt(Number a);
Number toFloat(Number a);
Number fromBool(Number a);
void multiplyExtended(Number a, Number b, formulas::IntegerSign sign, Number &high, Number &low);
Number refract(Number i, Number n, Number eta);
Number elementary(formulas::Elementary function, Number x);
Number elementary(formulas::Elementary function, Number x, Number y);
std::optional<std::int32_t> constantOf(Number x);

// A C++ number stands for one of the same type.
#define RTSL_BESIDE(function, Constant)                                                            \
  inline Number function(Number a, Constant b) {                                                   \
    return function(a, a.like(static_cast<double>(b)));                                            \
  }
#define RTSL_BEHIND(function, Constant)                                                            \
  inline Number function(Constant a, Number b) {                                                   \
    return function(b.like(static_cast<double>(a)), b);                                            \
  }
RTSL_BESIDE(operator+, double)
RTSL_BESIDE(operator-, double)
RTSL_BESIDE(operator*, double)
RTSL_BESIDE(operator/, double)
RTSL_BEHIND(operator+, double)
RTSL_BEHIND(operator-, double)
RTSL_BEHIND(operator*, double)
RTSL_BEHIND(operator/, double)
RTSL_BESIDE(operator&, std::int64_t)
RTSL_BESIDE(operator|, std::int64_t)
RTSL_BESIDE(operator^, std::int64_t)
RTSL_BESIDE(shiftLeft, int)
RTSL_BESIDE(shiftRight, int)
RTSL_BESIDE(shiftRightSigned, int)
RTSL_BESIDE(less, double)
RTSL_BESIDE(lessEqual, double)
RTSL_BESIDE(equal, double)
RTSL_BESIDE(notEqual, double)
RTSL_BEHIND(less, double)
RTSL_BEHIND(lessEqual, double)
#undef RTSL_BESIDE
#undef RTSL_BEHIND
inline Number select(Number condition, Number a, double b) {
  return select(condition, a, a.like(b));
}
inline Number select(Number condition, double a, Number b) {
  return select(condition, b.like(a), b);
}

// What is evaluated only where it is needed.
class Number::Variable {
public:
  Variable(const char *, const Number &) {}
  void operator=(const Number &x) { current = x; }
  Number value() const { return current; }

private:
  Number current;
};

inline bool isTrue(const Number &condition) {
  return condition.at(0).b;
}
template <typename Body>
void ifThen(const Number &condition, const Body &body) {
  if (isTrue(condition))
    body();
}
template <typename First, typename Second>
Number choose(const Number &condition, const Number &, const First &whenTrue,
              const Second &whenFalse) {
  return isTrue(condition) ? whenTrue() : whenFalse();
}
template <typename Condition, typename Body>
void repeatWhile(const Number &, const Condition &condition, const Body &body) {
  while (isTrue(condition()))
    body();
}
template <typename Body, typename... Others>
auto outline(const char *, const Body &body, const Number &first, const Others &...others) {
  return body(first, others...);
}
template <typename Body>
auto outline(const char *, const Body &body, const Columns &m) {
  return body(m);
}

} // namespace rtsl::fold
