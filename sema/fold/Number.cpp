//===- Number.cpp - known values with operators ---------------------------===//
#include "sema/fold/Number.h"

#include "math/Elementary.h"
#include "math/Refraction.h"
#include "sema/fold/ConstantFold.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace rtsl::fold {

using Scalar = Number::Scalar;
using Kind = Number::Kind;

//===----------------------------------------------------------------------===//
// Values
//===----------------------------------------------------------------------===//

static Kind kindOf(const Type &type) {
  const TypeKind scalar = type.scalar()->kind;
  return scalar == TypeKind::Float  ? Kind::Float
         : scalar == TypeKind::Bool ? Kind::Bool
                                    : Kind::Int;
}

Number::Number(const Type &type, const Scalar *first)
    : kind(kindOf(type)), components(type.isVector() ? type.count : 0) {
  std::copy(first, first + count(), scalars.begin());
}

void Number::appendTo(typed::Constant &constant) const {
  constant.scalars.insert(constant.scalars.end(), scalars.begin(), scalars.begin() + count());
}

Columns columnsOf(const Type &type, const typed::Constant &constant) {
  Columns columns;
  const Type &column = type.isMatrix() ? *type.element : type;
  for (std::size_t i = 0; i != type.componentCount(); i += column.componentCount())
    columns.emplace_back(column, constant.scalars.data() + i);
  return columns;
}

typed::Constant toConstant(const Columns &value) {
  typed::Constant constant;
  for (const Number &column : value)
    column.appendTo(constant);
  return constant;
}

static Scalar scalarOf(Kind kind, double value) {
  if (kind == Kind::Float)
    return makeFloat(static_cast<float>(value));
  if (kind == Kind::Bool)
    return makeBool(value != 0);
  return makeUInt(static_cast<std::uint32_t>(static_cast<std::int64_t>(value)));
}

Number Number::like(double constant) const {
  Number result(kind, components);
  std::fill_n(result.scalars.begin(), count(), scalarOf(kind, constant));
  return result;
}

Number Number::real(float constant) const {
  Number result(Kind::Float, 0);
  result.at(0) = makeFloat(constant);
  return result;
}

Number Number::integer(std::int32_t constant) const {
  Number result(Kind::Int, 0);
  result.at(0) = makeInt(constant);
  return result;
}

Number Number::constants(const std::vector<double> &values) const {
  assert(values.size() <= maxWidth);
  Number result(Kind::Float, static_cast<unsigned>(values.size()));
  for (unsigned i = 0; i != values.size(); ++i)
    result.at(i) = makeFloat(static_cast<float>(values[i]));
  return result;
}

Number Number::vector(const std::vector<Number> &components) {
  assert(components.size() <= maxWidth);
  Number result(components.front().kind, static_cast<unsigned>(components.size()));
  for (unsigned i = 0; i != components.size(); ++i)
    result.at(i) = components[i].at(0);
  return result;
}

Number Number::operator[](unsigned component) const {
  Number result(kind, 0);
  result.at(0) = at(component);
  return result;
}

Number Number::shuffle(std::initializer_list<int> indices) const {
  Number result(kind, static_cast<unsigned>(indices.size()));
  unsigned i = 0;
  for (int index : indices)
    result.at(i++) = at(static_cast<unsigned>(index));
  return result;
}

Number Number::as(Kind other) const {
  Number result = *this;
  result.kind = other;
  return result;
}

//===----------------------------------------------------------------------===//
// By component
//===----------------------------------------------------------------------===//

template <typename Operation>
static Number each(Kind kind, const Number &a, Operation operation) {
  Number result(kind, a.width());
  for (unsigned i = 0; i != result.count(); ++i)
    result.at(i) = operation(a.at(i));
  return result;
}
template <typename Operation>
static Number each(Kind kind, const Number &a, const Number &b, Operation operation) {
  Number result(kind, std::max(a.width(), b.width()));
  for (unsigned i = 0; i != result.count(); ++i)
    result.at(i) = operation(a.at(i), b.at(i));
  return result;
}
template <typename Operation>
static Number each(Kind kind, const Number &a, const Number &b, const Number &c,
                   Operation operation) {
  Number result(kind, std::max({a.width(), b.width(), c.width()}));
  for (unsigned i = 0; i != result.count(); ++i)
    result.at(i) = operation(a.at(i), b.at(i), c.at(i));
  return result;
}

template <typename Operation>
static Number eachFloat(const Number &a, Operation operation) {
  return each(Kind::Float, a, [&](Scalar x) { return makeFloat(operation(x.f)); });
}

template <typename Floats, typename Ints>
static Number arithmetic(const Number &a, const Number &b, Floats floats, Ints ints) {
  return each(a.scalarKind(), a, b, [&](Scalar x, Scalar y) {
    return a.isFloat() ? makeFloat(floats(x.f, y.f)) : makeUInt(ints(x.u, y.u));
  });
}

template <typename Ints>
static Number bitwise(const Number &a, const Number &b, Ints ints) {
  return each(a.scalarKind(), a, b, [&](Scalar x, Scalar y) { return makeUInt(ints(x.u, y.u)); });
}

template <typename Compare>
static Number compare(const Number &a, const Number &b, Compare compare) {
  return each(Kind::Bool, a, b, [&](Scalar x, Scalar y) {
    return makeBool(a.isFloat() ? compare(x.f, y.f) : compare(x.i, y.i));
  });
}

Number operator+(Number a, Number b) {
  return arithmetic(
      a, b, [](float x, float y) { return x + y; },
      [](std::uint32_t x, std::uint32_t y) { return x + y; });
}
Number operator-(Number a, Number b) {
  return arithmetic(
      a, b, [](float x, float y) { return x - y; },
      [](std::uint32_t x, std::uint32_t y) { return x - y; });
}
Number operator*(Number a, Number b) {
  return arithmetic(
      a, b, [](float x, float y) { return x * y; },
      [](std::uint32_t x, std::uint32_t y) { return x * y; });
}
Number operator/(Number a, Number b) {
  return each(Kind::Float, a, b, [](Scalar x, Scalar y) { return makeFloat(x.f / y.f); });
}
Number operator-(Number a) {
  return each(a.scalarKind(), a,
              [&](Scalar x) { return a.isFloat() ? makeFloat(-x.f) : makeUInt(0u - x.u); });
}
Number operator&(Number a, Number b) {
  return bitwise(a, b, [](std::uint32_t x, std::uint32_t y) { return x & y; });
}
Number operator|(Number a, Number b) {
  return bitwise(a, b, [](std::uint32_t x, std::uint32_t y) { return x | y; });
}
Number operator^(Number a, Number b) {
  return bitwise(a, b, [](std::uint32_t x, std::uint32_t y) { return x ^ y; });
}
Number operator!(Number a) {
  return each(Kind::Bool, a, [](Scalar x) { return makeBool(!x.b); });
}
Number shiftLeft(Number a, Number count) {
  return bitwise(a, count, [](std::uint32_t x, std::uint32_t n) { return x << (n & 31); });
}
Number shiftRight(Number a, Number count) {
  return bitwise(a, count, [](std::uint32_t x, std::uint32_t n) { return x >> (n & 31); });
}
Number shiftRightSigned(Number a, Number count) {
  return each(Kind::Int, a, count, [](Scalar x, Scalar n) { return makeInt(x.i >> (n.u & 31)); });
}

// Bools have 0 or 1 in their word (makeBool).
Number less(Number a, Number b) {
  return compare(a, b, [](auto x, auto y) { return x < y; });
}
Number lessEqual(Number a, Number b) {
  return compare(a, b, [](auto x, auto y) { return x <= y; });
}
Number equal(Number a, Number b) {
  return compare(a, b, [](auto x, auto y) { return x == y; });
}
Number notEqual(Number a, Number b) {
  return compare(a, b, [](auto x, auto y) { return x != y; });
}
Number lessUnsigned(Number a, Number b) {
  return each(Kind::Bool, a, b, [](Scalar x, Scalar y) { return makeBool(x.u < y.u); });
}

Number select(Number condition, Number a, Number b) {
  return each(a.scalarKind(), condition, a, b,
              [](Scalar c, Scalar x, Scalar y) { return c.b ? x : y; });
}

Number fma(Number a, Number b, Number c) {
  return each(Kind::Float, a, b, c,
              [](Scalar x, Scalar y, Scalar z) { return makeFloat(std::fma(x.f, y.f, z.f)); });
}
Number sqrt(Number a) {
  return eachFloat(a, [](float x) { return std::sqrt(x); });
}
Number floor(Number a) {
  return eachFloat(a, [](float x) { return std::floor(x); });
}
Number ceil(Number a) {
  return eachFloat(a, [](float x) { return std::ceil(x); });
}
Number trunc(Number a) {
  return eachFloat(a, [](float x) { return std::trunc(x); });
}
Number roundEven(Number a) {
  return eachFloat(a, [](float x) { return std::nearbyint(x); });
}
Number abs(Number a) {
  return each(a.scalarKind(), a, [&](Scalar x) {
    return a.isFloat() ? makeFloat(std::fabs(x.f)) : x.i < 0 ? makeUInt(0u - x.u) : x;
  });
}

Number toInt(Number a) {
  return each(Kind::Int, a,
              [](Scalar x) { return convertScalar(x, TypeKind::Float, TypeKind::Int); });
}
Number toFloat(Number a) {
  return each(Kind::Float, a,
              [](Scalar x) { return convertScalar(x, TypeKind::Int, TypeKind::Float); });
}
Number fromBool(Number a) {
  return each(Kind::Int, a, [](Scalar x) { return makeInt(x.b); });
}

//===----------------------------------------------------------------------===//
// Whole functions
//===----------------------------------------------------------------------===//

void multiplyExtended(Number a, Number b, formulas::IntegerSign sign, Number &high, Number &low) {
  auto product = [&](Scalar x, Scalar y) {
    return sign == formulas::IntegerSign::Unsigned
               ? std::uint64_t(x.u) * y.u
               : static_cast<std::uint64_t>(std::int64_t(x.i) * y.i);
  };
  high = each(Kind::Int, a, b, [&](Scalar x, Scalar y) {
    return makeUInt(static_cast<std::uint32_t>(product(x, y) >> 32));
  });
  low = each(Kind::Int, a, b, [&](Scalar x, Scalar y) {
    return makeUInt(static_cast<std::uint32_t>(product(x, y)));
  });
}

Number refract(Number i, Number n, Number eta) {
  float incident[4], normal[4], refracted[4];
  for (unsigned c = 0; c != i.count(); ++c) {
    incident[c] = i.at(c).f;
    normal[c] = n.at(c).f;
  }
  switch (i.count()) {
  case 1:
    device::refract<1>(incident, normal, eta.at(0).f, refracted);
    break;
  case 2:
    device::refract<2>(incident, normal, eta.at(0).f, refracted);
    break;
  case 3:
    device::refract<3>(incident, normal, eta.at(0).f, refracted);
    break;
  default:
    device::refract<4>(incident, normal, eta.at(0).f, refracted);
  }
  Number result(Kind::Float, i.width());
  for (unsigned c = 0; c != i.count(); ++c)
    result.at(c) = makeFloat(refracted[c]);
  return result;
}

Number elementary(formulas::Elementary function, Number x) {
  return eachFloat(x, [&](float argument) {
    switch (function) {
#define RTSL_ELEMENTARY_UNARY(Id, name)                                                            \
  case formulas::Elementary::Id:                                                                   \
    return device::name(argument);
#include "math/ElementaryFunctions.def"
    default:
      assert(!"not a function of one argument");
      return argument;
    }
  });
}

Number elementary(formulas::Elementary function, Number x, Number y) {
  return each(Kind::Float, x, y, [&](Scalar first, Scalar second) {
    switch (function) {
#define RTSL_ELEMENTARY_BINARY(Id, name)                                                           \
  case formulas::Elementary::Id:                                                                   \
    return makeFloat(device::name(first.f, second.f));
#include "math/ElementaryFunctions.def"
    default:
      assert(!"not a function of two arguments");
      return first;
    }
  });
}

std::optional<std::int32_t> constantOf(Number x) {
  return x.at(0).i;
}

} // namespace rtsl::fold
