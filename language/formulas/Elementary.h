//===- Elementary.h - sin, pow, sqrt and the like -------------------------===//
#pragma once

#include "language/formulas/Operations.h"

#include <cstdlib>
#include <optional>

namespace rtsl::formulas {

#define RTSL_ELEMENTARY_UNARY(Id, name)                                                            \
  template <typename Number>                                                                       \
  Number name(Number x) {                                                                          \
    return elementary(Elementary::Id, x);                                                          \
  }
#define RTSL_ELEMENTARY_BINARY(Id, name)                                                           \
  template <typename Number>                                                                       \
  Number name(Number x, Number y) {                                                                \
    return elementary(Elementary::Id, x, y);                                                       \
  }
#include "math/ElementaryFunctions.def"

inline constexpr double pi = 3.14159265358979323846;

template <typename Number>
Number radians(Number x) {
  return x * (pi / 180);
}
template <typename Number>
Number degrees(Number x) {
  return x * (180 / pi);
}

/// By squaring, from the lowest bit of |exponent| on: result *= base for a set bit, base *= base. A
/// negative exponent, a scalar, takes the reciprocal at the end. Each step rounds, so the error is
/// below |exponent| ulp.
template <typename Number>
Number powInt(Number x, Number exponent) {
  const std::optional<std::int32_t> constant = constantOf(exponent);
  if (constant && *constant >= -64 && *constant <= 64) {
    // The same operations as below, but for a factor of 1 at the start.
    Number result = x.like(1), base = x;
    bool isOne = true;
    for (auto n = static_cast<unsigned>(std::abs(*constant)); n != 0; n >>= 1) {
      if (n & 1) {
        result = isOne ? base : result * base;
        isOne = false;
      }
      if (n > 1)
        base = base * base;
    }
    return *constant < 0 ? 1.0 / result : result;
  }
  return outline(
      "powInt",
      [](Number x, Number exponent) {
        typename Number::Variable result("result", x), base("base", x), rest("rest", exponent);
        result = x.like(1);
        base = x;
        rest = abs(exponent);
        repeatWhile(
            x, [&] { return notEqual(rest.value(), 0.0); },
            [&] {
              ifThen(notEqual(rest.value() & 1, 0.0),
                     [&] { result = result.value() * base.value(); });
              base = base.value() * base.value();
              rest = shiftRight(rest.value(), 1);
            });
        return select(less(exponent, 0.0), 1.0 / result.value(), result.value());
      },
      x, exponent);
}

} // namespace rtsl::formulas
