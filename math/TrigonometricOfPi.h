// sinpi and cospi: sine and cosine of pi x.
#pragma once

#include "math/Trigonometric.h"

namespace rtsl::device {

namespace detail {

/// Every float from here on is an integer.
inline constexpr float onlyIntegersFrom = 0x1p23f;

/// x = q/2 + r with |r| <= 1/4, exactly.
struct HalfTurnReduction {
  int quadrant;
  double rest;
};

/// For 0 <= x < 2^23.
inline HalfTurnReduction reduceHalfTurns(float x) {
  NearestInteger q = nearestInteger(2.0 * double(x));
  return {q.asInt, fma(-0.5, q.asDouble, double(x))};
}

/// Sine and cosine where x is an integer from 2^23 on, infinite or NaN.
inline SineAndCosine halfTurnsOutside(float x) {
  float a = absolute(x);
  if (!(a < infinity()))
    return {canonicalNaN(), canonicalNaN()};
  bool odd = a < 0x1p24f && (bitsOf(a) & 1) != 0;
  return {0.0f, odd ? -1.0f : 1.0f};
}

[[gnu::cold, gnu::const, gnu::noinline]] inline SineAndCosine carefulSineAndCosineOfPi(float x) {
  HalfTurnReduction reduced = reduceHalfTurns(absolute(x));
  Double2 angle = multiply({reduced.rest, 0.0}, pi);
  Double2 sine = sineKernel(angle), cosine = cosineKernel(angle);
  bool odd = (reduced.quadrant & 1) != 0;
  return inQuadrant(reduced.quadrant, bitsOf(x) >= floatSignBit, roundToFloat(odd ? cosine : sine),
                    roundToFloat(odd ? sine : cosine));
}

/// Both of pi x, with zeros of any sign.
inline SineAndCosine sineAndCosineOfPiUpToZeros(float x) {
  float a = absolute(x);
  if (!(a < onlyIntegersFrom))
    return halfTurnsOutside(x);
  HalfTurnReduction reduced = reduceHalfTurns(a);
  double angle = reduced.rest * pi.hi;
  double sine = plainSine(angle), cosine = plainCosine(angle);
  bool odd = (reduced.quadrant & 1) != 0;
  double upright = odd ? cosine : sine, level = odd ? sine : cosine;
  // Below, the sine may be subnormal, where roundsSafely() is not valid.
  if (!(a >= 0x1p-120f && roundsSafely(upright) && roundsSafely(level)))
    return carefulSineAndCosineOfPi(x);
  return inQuadrant(reduced.quadrant, bitsOf(x) >= floatSignBit, float(upright), float(level));
}

} // namespace detail

/// Both of pi x. As in IEEE 754-2019 the sine of an integer is a zero with its sign, and the cosine
/// halfway between integers is +0.
inline SineAndCosine sineAndCosineOfPi(float x) {
  SineAndCosine both = detail::sineAndCosineOfPiUpToZeros(x);
  if (both.sine == 0.0f)
    both.sine = detail::bitsOf(x) >= detail::floatSignBit ? -0.0f : 0.0f;
  if (both.cosine == 0.0f)
    both.cosine = 0.0f;
  return both;
}

/// sin(pi x).
inline float sinpi(float x) {
  return sineAndCosineOfPi(x).sine;
}

/// cos(pi x).
inline float cospi(float x) {
  return sineAndCosineOfPi(x).cosine;
}

} // namespace rtsl::device
