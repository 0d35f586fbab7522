//===- Common.h - min, mix, mod, frexp and the like -----------------------===//
//
// The rules are those of docs/language.md, chapters 4 and 11.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "language/formulas/Comparison.h"

#include <array>
#include <limits>

namespace rtsl::formulas {

inline constexpr double infinity = std::numeric_limits<double>::infinity();

/// y < x ? y : x
template <typename Number>
Number minimum(Number x, Number y, IntegerSign sign = IntegerSign::Signed) {
  return select(lessThan(y, x, sign), y, x);
}
/// x < y ? y : x
template <typename Number>
Number maximum(Number x, Number y, IntegerSign sign = IntegerSign::Signed) {
  return select(lessThan(x, y, sign), y, x);
}
template <typename Number>
Number clamp(Number x, Number low, Number high, IntegerSign sign = IntegerSign::Signed) {
  return minimum(maximum(x, low, sign), high, sign);
}
template <typename Number>
Number mix(Number a, Number b, Number t) {
  return a * (1.0 - t) + b * t;
}
template <typename Number>
Number mixSelect(Number a, Number b, Number choice) {
  return select(choice, b, a);
}

/// x < edge ? 0 : 1
template <typename Number>
Number step(Number edge, Number x) {
  Number below = less(x, edge);
  Number one = x.like(1);
  return select(below, 0.0, one);
}

template <typename Number>
Number smoothstep(Number edge0, Number edge1, Number x) {
  Number t = (x - edge0) / (edge1 - edge0);
  t = clamp(t, t.like(0), t.like(1));
  return (t * t) * (3.0 - 2.0 * t);
}

/// The sign: -1 or 1; zero for zero, and NaN for NaN.
template <typename Number>
Number sign(Number x) {
  return select(less(0.0, x), 1.0, select(less(x, 0.0), -1.0, x));
}
/// 1 for a tiny negative x.
template <typename Number>
Number fract(Number x) {
  return x - floor(x);
}
template <typename Number>
Number mod(Number x, Number y) {
  return x - y * floor(x / y);
}

template <typename Number>
Number copySign(Number magnitude, Number sign) {
  return ((magnitude.bits() & 0x7fffffff) | (sign.bits() & 0x80000000)).asFloat();
}

/// Both parts have the sign of x; the fraction of an infinity is 0.
template <typename Number>
Number modf(Number x, Number &whole) {
  whole = trunc(x);
  Number fraction = select(equal(x, whole), 0.0, x - whole);
  return copySign(fraction, x);
}

template <typename Number>
Number isNan(Number x) {
  return notEqual(x, x);
}
template <typename Number>
Number isInf(Number x) {
  return equal(abs(x), infinity);
}

/// The bits of a NaN differ from machine to machine, so the result is the same for all of them.
template <typename Number>
Number floatBits(Number x) {
  return select(isNan(x), 0x7fc00000, x.bits());
}
template <typename Number>
Number floatOfBits(Number x) {
  return x.asFloat();
}

/// From the first component on.
template <typename Number>
Number minComponent(Number v, IntegerSign sign) {
  Number result = v[0];
  for (unsigned i = 1; i < v.count(); ++i)
    result = minimum(result, v[i], sign);
  return result;
}
template <typename Number>
Number maxComponent(Number v, IntegerSign sign = IntegerSign::Signed) {
  Number result = v[0];
  for (unsigned i = 1; i < v.count(); ++i)
    result = maximum(result, v[i], sign);
  return result;
}

/// An int.
template <typename Number>
Number dominantAxis(Number v) {
  Number magnitude = abs(v);
  Number largest = magnitude[0];
  Number axis = v.integer(0);
  for (unsigned i = 1; i < v.count(); ++i) {
    Number isLarger = less(largest, magnitude[i]);
    axis = select(isLarger, i, axis);
    largest = select(isLarger, magnitude[i], largest);
  }
  return axis;
}

template <typename Number>
Number inside(Number x, Number low, Number high, IntegerSign sign) {
  Number isNotAbove = all(lessThanEqual(x, high, sign));
  return all(lessThanEqual(low, x, sign)) & isNotAbove;
}

//===----------------------------------------------------------------------===//
// Parts of a number
//===----------------------------------------------------------------------===//

/// x = significand * 2^exponent with the significand in [0.5, 1). Zero, infinities and NaN have
/// exponent 0.
template <typename Number>
Number frexp(Number x, Number &exponent) {
  const std::array<Number, 2> parts = outline(
      "frexp",
      [](Number x) {
        // A subnormal becomes normal by an exact factor.
        Number isSmall = less(abs(x), 0x1p-126);
        Number bits = select(isSmall, x * 0x1p24, x).bits();
        Number exponent = (shiftRight(bits, 23) & 0xff) - 126.0;
        exponent = select(isSmall, exponent - 24.0, exponent);
        Number significand = ((bits & 0x807fffff) | 0x3f000000).asFloat();
        Number hasParts = less(0.0, abs(x)) & less(abs(x), infinity);
        return std::array<Number, 2>{select(hasParts, significand, x),
                                     select(hasParts, exponent, 0.0)};
      },
      x);
  exponent = parts[1];
  return parts[0];
}

/// x * 2^exponent, rounded once. Three factors reach every result: the factors above 1 are exact; a
/// factor below 2^-126 is taken in steps of 2^-102, and where such a step rounds, what follows
/// makes the result zero.
template <typename Number>
Number ldexp(Number x, Number exponent) {
  return outline(
      "ldexp",
      [](Number x, Number exponent) {
        Number result = x;
        Number rest = clamp(exponent, exponent.like(-280), exponent.like(280));
        for (int i = 0; i < 3; ++i) {
          Number part =
              i == 2 ? rest : select(less(rest, -126.0), -102.0, minimum(rest, rest.like(127)));
          result = result * shiftLeft(part + 127.0, 23).asFloat();
          rest = rest - part;
        }
        return result;
      },
      x, exponent);
}

} // namespace rtsl::formulas
