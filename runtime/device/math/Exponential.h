// exp, exp2 and expm1.
#pragma once

#include "runtime/device/math/ExponentialKernel.h"
#include "runtime/device/math/Rounding.h"

namespace rtsl::device {

/// e^x.
inline float exp(float x) {
  using namespace detail;
  if (isNaN(x))
    return canonicalNaN();
  if (x > 89.0f) // e^89 > 2^128
    return infinity();
  if (x < -104.0f) // e^-104 < 2^-150
    return 0.0f;
  Double2 y = exponential(x);
  return roundToFloat(y);
}

/// 2^x. Exact for integers.
inline float exp2(float x) {
  using namespace detail;
  if (isNaN(x))
    return canonicalNaN();
  if (x >= 128.0f)
    return infinity();
  if (x < -150.0f)
    return 0.0f;
  NearestInteger step = nearestInteger(double(x) * exponentialTableSize);
  double fraction = fma(step.asDouble, -1.0 / exponentialTableSize, x); // exact
  double remainder = fma(fraction, ln2.hi, fraction * ln2.lo);
  Double2 y = scaledExponential(step.asInt, exponentialTail(remainder));
  return roundToFloat(y);
}

namespace detail {

/// e^x - 1 as hi + lo for |x| < 700, accurate near zero.
inline Double2 exponentialMinusOne(double x) {
  ExponentialReduction reduced = reduceExponential(x);
  double r = reduced.remainder, curvature = exponentialCurvature(r);
  if (reduced.step == 0)
    return {r, curvature};
  Double2 y = scaledExponential(reduced.step, r + curvature);
  Double2 head = twoSum(y.hi, -1.0);
  return {head.hi, head.lo + y.lo};
}

} // namespace detail

/// e^x - 1, accurate near zero.
inline float expm1(float x) {
  using namespace detail;
  if (isNaN(x))
    return canonicalNaN();
  if (x > 89.0f)
    return infinity();
  if (x < -18.0f) // e^-18 < 2^-25
    return -1.0f;
  if (x == 0.0f)
    return x;
  Double2 y = exponentialMinusOne(x);
  return roundToFloat(y);
}

} // namespace rtsl::device
