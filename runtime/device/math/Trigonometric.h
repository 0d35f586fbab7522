// sin, cos and tan.
#pragma once

#include "runtime/device/math/ArgumentReduction.h"
#include "runtime/device/math/Rounding.h"

namespace rtsl::device {

namespace detail {

/// sin(r) for |r| <= pi/4, by Taylor's series up to r^17/17!; what is left out is below 2^-62 |r|.
inline Double2 sineKernel(Double2 r) {
  double z = r.hi * r.hi;
  double q = fma(z, 1.0 / 355687428096000, -1.0 / 1307674368000);
  q = fma(z, q, 1.0 / 6227020800);
  q = fma(z, q, -1.0 / 39916800);
  q = fma(z, q, 1.0 / 362880);
  q = fma(z, q, -1.0 / 5040);
  q = fma(z, q, 1.0 / 120);
  q = fma(z, q, -1.0 / 6);
  double low = fma(-0.5 * z, r.lo, r.lo); // r.lo cos(r)
  return {r.hi, fma(r.hi * z, q, low)};
}

/// cos(r) for |r| <= pi/4, by Taylor's series up to r^18/18!; what is left out is below 2^-67.
inline Double2 cosineKernel(Double2 r) {
  double z = r.hi * r.hi, zLow = fma(r.hi, r.hi, -z);
  double q = fma(z, -1.0 / 6402373705728000, 1.0 / 20922789888000);
  q = fma(z, q, -1.0 / 87178291200);
  q = fma(z, q, 1.0 / 479001600);
  q = fma(z, q, -1.0 / 3628800);
  q = fma(z, q, 1.0 / 40320);
  q = fma(z, q, -1.0 / 720);
  q = fma(z, q, 1.0 / 24);
  Double2 head = fastTwoSum(1.0, -0.5 * z);
  double low = fma(-r.hi, r.lo, fma(-0.5, zLow, head.lo)); // -r.lo sin(r), and what 1 - z/2 lost
  return {head.hi, fma(z * z, q, low)};
}

} // namespace detail

/// Sine of x radians.
inline float sin(float x) {
  using namespace detail;
  float a = absolute(x);
  if (!(a < infinity()))
    return canonicalNaN();
  QuadrantReduction reduced = reduceToQuadrant(a);
  Double2 y = (reduced.quadrant & 1) != 0 ? cosineKernel(reduced.rest) : sineKernel(reduced.rest);
  float magnitude = roundToFloat(y);
  bool negative = ((reduced.quadrant & 2) != 0) != (bitsOf(x) >= floatSignBit);
  return negative ? -magnitude : magnitude;
}

/// Cosine of x radians.
inline float cos(float x) {
  using namespace detail;
  float a = absolute(x);
  if (!(a < infinity()))
    return canonicalNaN();
  QuadrantReduction reduced = reduceToQuadrant(a);
  Double2 y = (reduced.quadrant & 1) != 0 ? sineKernel(reduced.rest) : cosineKernel(reduced.rest);
  float magnitude = roundToFloat(y);
  bool negative = ((reduced.quadrant + 1) & 2) != 0;
  return negative ? -magnitude : magnitude;
}

/// Tangent of x radians.
inline float tan(float x) {
  using namespace detail;
  float a = absolute(x);
  if (!(a < infinity()))
    return canonicalNaN();
  QuadrantReduction reduced = reduceToQuadrant(a);
  Double2 sine = normalized(sineKernel(reduced.rest));
  Double2 cosine = normalized(cosineKernel(reduced.rest));
  bool odd = (reduced.quadrant & 1) != 0;
  float magnitude = roundToFloat(odd ? quotient(negate(cosine), sine) : quotient(sine, cosine));
  return bitsOf(x) >= floatSignBit ? -magnitude : magnitude;
}

} // namespace rtsl::device
