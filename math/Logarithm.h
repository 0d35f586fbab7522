// log, log2 and log1p.
#pragma once

#include "math/kernels/LogarithmKernel.h"
#include "math/kernels/Rounding.h"

namespace rtsl::device {

namespace detail {

/// A logarithm of zero, infinity, a negative number or NaN.
inline float specialLogarithm(float x) {
  return x == 0.0f ? -infinity() : x > 0.0f ? x : canonicalNaN();
}

/// For x that is not normal, or if plain double does not decide.
[[gnu::cold, gnu::const, gnu::noinline]] inline float carefulNaturalLogarithm(float x) {
  return x > 0.0f && x < infinity() ? roundToFloat(naturalLogarithm({x, 0.0}))
                                    : specialLogarithm(x);
}
[[gnu::cold, gnu::const, gnu::noinline]] inline float carefulBinaryLogarithm(float x) {
  return x > 0.0f && x < infinity() ? roundToFloat(binaryLogarithm(x)) : specialLogarithm(x);
}

} // namespace detail

/// Natural logarithm. -infinity at both zeros, NaN below.
inline float log(float x) {
  using namespace detail;
  if (isPositiveNormal(x)) {
    LogarithmReduction reduced = reduceLogarithmOfNormal(x);
    double y = quickLogarithm(reduced, reduced.exponent);
    if (roundsSafely(y))
      return float(y);
  }
  return carefulNaturalLogarithm(x);
}

/// Logarithm to base 2. Exact for powers of two.
inline float log2(float x) {
  using namespace detail;
  if (isPositiveNormal(x)) {
    LogarithmReduction reduced = reduceLogarithmOfNormal(x);
    double y = fma(quickLogarithm(reduced, 0.0), inverseLn2.hi, double(reduced.exponent));
    if (roundsSafely(y))
      return float(y);
  }
  return carefulBinaryLogarithm(x);
}

/// ln(1 + x), accurate near zero. -infinity at -1, NaN below.
inline float log1p(float x) {
  using namespace detail;
  if (x == -1.0f)
    return -infinity();
  if (!(x > -1.0f))
    return canonicalNaN();
  if (x == infinity() || x == 0.0f)
    return x;
  Double2 y = naturalLogarithmOfOnePlus({x, 0.0});
  return roundToFloat(y);
}

} // namespace rtsl::device
