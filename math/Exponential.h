// exp, exp2 and expm1.
#pragma once

#include "math/kernels/ExponentialKernel.h"
#include "math/kernels/Rounding.h"

namespace rtsl::device {

namespace detail {

/// e^x if plain double does not decide, or the result is not a normal float.
[[gnu::cold, gnu::const, gnu::noinline]] inline float carefulExponential(float x) {
  if (isNaN(x))
    return canonicalNaN();
  if (x > 89.0f) // e^89 > 2^128
    return infinity();
  if (x < -104.0f) // e^-104 < 2^-150
    return 0.0f;
  return roundToFloat(exponential(x));
}

/// 2^x = 2^(step/64 + fraction).
struct BinaryReduction {
  NearestInteger step;
  double fraction;
};

inline BinaryReduction reduceBinary(double x) {
  NearestInteger step = nearestInteger(x * exponentialTableSize);
  return {step, fma(step.asDouble, -1.0 / exponentialTableSize, x)}; // exact
}

/// 2^x if plain double does not decide, or the result is not a normal float.
[[gnu::cold, gnu::const, gnu::noinline]] inline float carefulBinaryExponential(float x) {
  if (isNaN(x))
    return canonicalNaN();
  if (x >= 128.0f)
    return infinity();
  if (x < -150.0f)
    return 0.0f;
  BinaryReduction reduced = reduceBinary(x);
  double remainder = fma(reduced.fraction, ln2.hi, reduced.fraction * ln2.lo);
  return roundToFloat(scaledExponential(reduced.step.asInt, exponentialTail(remainder)));
}

} // namespace detail

/// e^x.
inline float exp(float x) {
  using namespace detail;
  if (!(x > -87.0f && x < 89.0f)) // e^-87 > 2^-126
    return carefulExponential(x);
  double y = plainExponential(x);
  return roundsSafely(y) ? float(y) : carefulExponential(x);
}

/// 2^x. Exact for integers.
inline float exp2(float x) {
  using namespace detail;
  if (!(x > -126.0f && x < 128.0f))
    return carefulBinaryExponential(x);
  BinaryReduction reduced = reduceBinary(x);
  double y =
      plainScaledExponential(reduced.step.asInt, plainExponentialTail(reduced.fraction * ln2.hi));
  return roundsSafely(y) ? float(y) : carefulBinaryExponential(x);
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
