// sin, cos and tan.
#pragma once

#include "math/kernels/ArgumentReduction.h"
#include "math/kernels/Rounding.h"
#include "math/kernels/SineSeries.h"

namespace rtsl::device {

struct SineAndCosine {
  float sine, cosine;
};

namespace detail {

/// Sine and cosine from their values at the angle's distance from the quadrant's start, which were
/// exchanged already where the quadrant is odd.
inline SineAndCosine inQuadrant(int quadrant, bool isNegative, float sine, float cosine) {
  return {((quadrant & 2) != 0) != isNegative ? -sine : sine,
          ((quadrant + 1) & 2) != 0 ? -cosine : cosine};
}

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

/// Sine and cosine of x, correctly rounded, in double with a low part.
[[gnu::cold, gnu::const, gnu::noinline]] inline SineAndCosine carefulSineAndCosine(float x) {
  QuadrantReduction reduced = reduceToQuadrant(absolute(x));
  Double2 sine = sineKernel(reduced.rest), cosine = cosineKernel(reduced.rest);
  bool odd = (reduced.quadrant & 1) != 0;
  return inQuadrant(reduced.quadrant, bitsOf(x) >= floatSignBit, roundToFloat(odd ? cosine : sine),
                    roundToFloat(odd ? sine : cosine));
}

/// Below this the reduction in plain double, and the following steps, stay within plainBound.
inline constexpr float plainTrigonometricLimit = 0x1p10f;

} // namespace detail

/// Both of x radians, at little more than the cost of one. Plain double decides the rounding except
/// for about one number in 2^17.
inline SineAndCosine sineAndCosine(float x) {
  using namespace detail;
  float a = absolute(x);
  if (!(a < plainTrigonometricLimit)) {
    if (!(a < infinity()))
      return {canonicalNaN(), canonicalNaN()};
    return carefulSineAndCosine(x);
  }
  NearestInteger q = nearestInteger(double(a) * twoOverPi);
  double first = fma(-q.asDouble, halfPiParts[0], double(a)); // exact
  double rest = fma(-q.asDouble, halfPiParts[1], first);
  // Both series are needed anyway, and a select is cheaper than an unpredictable branch.
  double sine = plainSine(rest), cosine = plainCosine(rest);
  bool odd = (q.asInt & 1) != 0;
  double upright = odd ? cosine : sine, level = odd ? sine : cosine;

  if (!(roundsSafely(upright) && roundsSafely(level)))
    return carefulSineAndCosine(x);
  return inQuadrant(q.asInt, bitsOf(x) >= floatSignBit, float(upright), float(level));
}

/// Sine of x radians.
inline float sin(float x) {
  return sineAndCosine(x).sine;
}

/// Cosine of x radians.
inline float cos(float x) {
  return sineAndCosine(x).cosine;
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
