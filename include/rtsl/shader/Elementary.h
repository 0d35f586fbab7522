//===- Elementary.h - sin, pow, sqrt and the like -------------------------===//
//
// Correctly rounded: the runtime library holds them, compiled from the source that the compiler's
// own machine code uses (runtime/device/math).
//
//===----------------------------------------------------------------------===//
#pragma once

#include "rtsl/shader/Common.h"

/// X(name) for each function of one number.
#define RTSL_ELEMENTARY_FUNCTIONS(X)                                                               \
  X(sin) X(cos) X(tan) X(asin) X(acos) X(atan) X(sinh) X(cosh) X(tanh) X(asinh)                    \
  X(acosh) X(atanh) X(exp) X(exp2) X(log) X(log2) X(inversesqrt)

extern "C" {
#define RTSL_DECLARE(name) float rtsl_##name(float x);
RTSL_ELEMENTARY_FUNCTIONS(RTSL_DECLARE)
#undef RTSL_DECLARE
float rtsl_atan2(float y, float x);
float rtsl_pow(float x, float y);
}

namespace rtsl {

#define RTSL_DEFINE(name)                                                                          \
  template <typename T>                                                                            \
  inline auto name(const T &value) {                                                               \
    return each([](float x) { return rtsl_##name(x); }, value);                                    \
  }
RTSL_ELEMENTARY_FUNCTIONS(RTSL_DEFINE)
#undef RTSL_DEFINE
#undef RTSL_ELEMENTARY_FUNCTIONS

template <typename Y, typename X>
inline auto atan(const Y &a, const X &b) {
  return each([](float y, float x) { return rtsl_atan2(y, x); }, a, b);
}
template <typename X, typename Y>
inline auto pow(const X &base, const Y &exponent) {
  return each([](float x, float y) { return rtsl_pow(x, y); }, base, exponent);
}

/// By squaring, from the lowest bit of |exponent| on; a negative exponent takes the reciprocal at
/// the end. Each step rounds, so the error is below |exponent| ulp.
template <typename T>
constexpr auto powi(const T &value, int exponent) {
  return each(
      [](float base, int n) {
        float result = 1.0f;
        for (uint rest = n < 0 ? 0u - static_cast<uint>(n) : static_cast<uint>(n); rest != 0;) {
          if ((rest & 1u) != 0)
            result = result * base;
          rest >>= 1;
          if (rest != 0)
            base = base * base;
        }
        return n < 0 ? 1.0f / result : result;
      },
      value, exponent);
}

template <typename T>
inline auto sqrt(const T &value) {
  return each([](float x) { return std::sqrt(x); }, value);
}
template <typename T>
inline auto radians(const T &degrees) {
  return each([](float x) { return x * static_cast<float>(3.14159265358979323846 / 180); },
              degrees);
}
template <typename T>
inline auto degrees(const T &radians) {
  return each([](float x) { return x * static_cast<float>(180 / 3.14159265358979323846); },
              radians);
}

} // namespace rtsl
