// sinh, cosh and tanh.
#pragma once

#include "math/Exponential.h"

namespace rtsl::device {

namespace detail {

/// sinh(x) for 0 <= x < 1 by Taylor's series up to x^19/19!; what is left out is below 2^-65.
inline Double2 hyperbolicSineSeries(double x) {
  double z = x * x;
  double q = fma(z, 1.0 / 121645100408832000, 1.0 / 355687428096000);
  q = fma(z, q, 1.0 / 1307674368000);
  q = fma(z, q, 1.0 / 6227020800);
  q = fma(z, q, 1.0 / 39916800);
  q = fma(z, q, 1.0 / 362880);
  q = fma(z, q, 1.0 / 5040);
  q = fma(z, q, 1.0 / 120);
  q = fma(z, q, 1.0 / 6);
  return {x, x * z * q};
}

} // namespace detail

/// Hyperbolic sine.
inline float sinh(float x) {
  using namespace detail;
  if (isNaN(x))
    return canonicalNaN();
  float a = absolute(x);
  if (a > 90.0f) // sinh(90) > 2^128
    return withSignOf(infinity(), x);
  if (a < 1.0f)
    return withSignOf(roundToFloat(hyperbolicSineSeries(a)), x);
  Double2 growing = exponential(a), decaying = exponential(-double(a));
  Double2 difference = fastTwoSum(growing.hi, -decaying.hi);
  difference.lo += growing.lo - decaying.lo;
  return withSignOf(roundToFloat(half(difference)), x);
}

/// Hyperbolic cosine.
inline float cosh(float x) {
  using namespace detail;
  if (isNaN(x))
    return canonicalNaN();
  float a = absolute(x);
  if (a > 90.0f)
    return infinity();
  Double2 growing = exponential(a), decaying = exponential(-double(a));
  Double2 sum = fastTwoSum(growing.hi, decaying.hi);
  sum.lo += growing.lo + decaying.lo;
  return roundToFloat(half(sum));
}

/// Hyperbolic tangent, as E/(E + 2) with E = e^(2x) - 1.
inline float tanh(float x) {
  using namespace detail;
  if (isNaN(x))
    return canonicalNaN();
  float a = absolute(x);
  if (a > 9.1f) // 1 - tanh(9.1) < 2^-25
    return withSignOf(1.0f, x);
  Double2 numerator = normalized(exponentialMinusOne(2.0 * a));
  Double2 denominator = twoSum(numerator.hi, 2.0);
  denominator = normalized({denominator.hi, denominator.lo + numerator.lo});
  return withSignOf(roundToFloat(quotient(numerator, denominator)), x);
}

} // namespace rtsl::device
