// asinh, acosh and atanh, as logarithms of 1 + t with t free of cancellation (Kahan, "Branch cuts
// for complex elementary functions", in: The State of the Art in Numerical Analysis, 1987).
#pragma once

#include "math/kernels/LogarithmKernel.h"
#include "math/kernels/Rounding.h"

namespace rtsl::device {

/// Inverse hyperbolic sine: ln(1 + a + a^2/(1 + sqrt(1 + a^2))), a = |x|.
inline float asinh(float x) {
  using namespace detail;
  if (isNaN(x))
    return canonicalNaN();
  float magnitude = absolute(x);
  if (magnitude == infinity() || magnitude == 0.0f)
    return x;
  double a = magnitude;
  double root = squareRoot(fma(a, a, 1.0));
  Double2 t = twoSum(a, a * a / (1.0 + root));
  Double2 y = naturalLogarithmOfOnePlus(t);
  return withSignOf(roundToFloat(y), x);
}

/// Inverse hyperbolic cosine: ln(1 + w + sqrt(w (x + 1))), w = x - 1. NaN below 1.
inline float acosh(float x) {
  using namespace detail;
  if (!(x >= 1.0f))
    return canonicalNaN();
  if (x == infinity())
    return x;
  if (x == 1.0f)
    return 0.0f;
  double w = x - 1.0;
  Double2 root = squareRootOf(w * (x + 1.0));
  Double2 t = twoSum(root.hi, w);
  t.lo += root.lo;
  Double2 y = naturalLogarithmOfOnePlus(t);
  return roundToFloat(y);
}

/// Inverse hyperbolic tangent: ln(1 + 2a/(1 - a))/2, a = |x|. Infinite at 1, NaN beyond.
inline float atanh(float x) {
  using namespace detail;
  float magnitude = absolute(x);
  if (!(magnitude <= 1.0f))
    return canonicalNaN();
  if (magnitude == 1.0f)
    return withSignOf(infinity(), x);
  if (magnitude == 0.0f)
    return x;
  double a = magnitude;
  Double2 denominator = twoSum(1.0, -a);
  double inverse = 1.0 / denominator.hi;
  double t = 2.0 * a * inverse;
  double remainder = fma(-t, denominator.lo, fma(-t, denominator.hi, 2.0 * a));
  Double2 y = naturalLogarithmOfOnePlus({t, remainder * inverse});
  return withSignOf(roundToFloat(half(y)), x);
}

} // namespace rtsl::device
