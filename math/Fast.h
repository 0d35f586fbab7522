// Approximations in single precision, for --fp=fast: the functions that shaders call most.
//
// Only float arithmetic (except in sin, cos and tan of |x| >= 2^13, which are those of
// Elementary.h). Each function states its error bound; `elementary-exhaustive fast` measures it
// over all floats. Errors are relative to the result, or to the smallest normal float if the result
// is smaller. Zeros, infinities, NaNs and domain errors are as in Elementary.h, except that any NaN
// may result. Functions that are missing here are those of Elementary.h.
#pragma once

#include "math/ArcTangent2.h"
#include "math/Power.h"
#include "math/Trigonometric.h"
#include "math/TrigonometricOfPi.h"
#include "math/kernels/ArgumentReduction.h"
#include "math/tables/ArcTangentTable.h"

namespace rtsl::device::fast {

namespace detail {

using namespace device::detail;

#if defined(__clang__)
inline float fma(float a, float b, float c) {
  return __builtin_elementwise_fma(a, b, c);
}
#else
inline float fma(float a, float b, float c) {
  return __builtin_fmaf(a, b, c);
}
#endif

/// The integer nearest to x, for |x| < 2^22, as nearestInteger() in double.
inline float nearest(float x) {
  constexpr float shifter = 0x1.8p23f;
  return (x + shifter) - shifter;
}

/// y 2^k for -300 < k < 300, in two steps so that subnormal results are rounded once.
inline float scale(float y, int k) {
  int half = k >> 1;
  float first = floatOf(uint32_t(half + 127) << 23);
  float second = floatOf(uint32_t(k - half + 127) << 23);
  return y * first * second;
}

// ---- exponential functions

/// e^r for |r| <= 0.35, by Taylor's series up to r^7/5040; what is left out is below 2^-27.
inline float exponentialSeries(float r) {
  float q = fma(r, 1.0f / 5040, 1.0f / 720);
  q = fma(r, q, 1.0f / 120);
  q = fma(r, q, 1.0f / 24);
  q = fma(r, q, 1.0f / 6);
  q = fma(r, q, 0.5f);
  q = fma(r, q, 1.0f);
  return fma(r, q, 1.0f);
}

// ---- logarithms

/// x = 2^exponent m with 11/16 <= m < 11/8, and ln(m).
struct Logarithm {
  float exponent, ofM;
};

/// For positive finite x. ln(m) = 2 artanh(s), s = (m - 1)/(m + 1), |s| <= 5/27; the series up to
/// s^9/9 leaves less than 2^-27 |s|.
inline Logarithm logarithm(float x) {
  bool subnormal = x < 0x1p-126f;
  float normal = subnormal ? x * 0x1p24f : x;
  uint32_t distance = bitsOf(normal) - bitsOf(0.6875f);
  int exponent = int(distance) >> 23;
  float m = floatOf(bitsOf(normal) - (uint32_t(exponent) << 23));
  float s = (m - 1.0f) / (m + 1.0f);
  float z = s * s;
  float q = fma(z, 1.0f / 9, 1.0f / 7);
  q = fma(z, q, 1.0f / 5);
  q = fma(z, q, 1.0f / 3);
  return {float(subnormal ? exponent - 24 : exponent), 2.0f * fma(s * z, q, s)};
}

/// The logarithm of a float that is not positive and finite.
inline float logarithmOutside(float x) {
  if (x == 0.0f)
    return -infinity();
  return x > 0.0f ? x : canonicalNaN();
}

// ---- trigonometric functions

struct Quadrant {
  int quadrant;
  float rest;
};

/// The largest argument that reduce() is for: the product of a quadrant's number with the first
/// part of pi/2 is exact below it.
inline constexpr float mostReduced = 0x1p13f;

/// For 0 <= a < mostReduced: pi/2 in three parts of 9, 24 and 24 bits.
inline Quadrant reduce(float a) {
  constexpr float first = 0x1.92p0f;
  constexpr float second = float(halfPi.hi - double(first));
  constexpr float third = float(halfPi.hi - double(first) - double(second) + halfPi.lo);
  float q = nearest(a * float(twoOverPi));
  float rest = fma(-q, first, a);
  rest = fma(-q, second, rest);
  return {int(q), fma(-q, third, rest)};
}

/// sin(r) or cos(r) for |r| <= pi/4, by Taylor's series up to r^9 or r^8. The coefficients are
/// selected, not the code: a branch on the quadrant would be unpredictable.
inline float series(float r, bool isCosine) {
  float z = r * r;
  float q = fma(z, isCosine ? 1.0f / 40320 : 1.0f / 362880, isCosine ? -1.0f / 720 : -1.0f / 5040);
  q = fma(z, q, isCosine ? 1.0f / 24 : 1.0f / 120);
  q = fma(z, q, isCosine ? -0.5f : -1.0f / 6);
  return fma(isCosine ? z : r * z, q, isCosine ? 1.0f : r);
}

inline float withFlippedSign(float x, bool flip) {
  return floatOf(bitsOf(x) ^ (flip ? floatSignBit : 0u));
}

/// a = quadrant/2 + rest/pi for 0 <= a < mostHalfTurns.
inline constexpr float mostHalfTurns = 0x1p21f;
inline Quadrant reduceHalfTurns(float a) {
  float q = nearest(2.0f * a);
  return {int(q), fma(-0.5f, q, a) * float(pi.hi)};
}
/// y, with its sign flipped in the third and fourth quadrant unless it is 0, and by `sign`.
inline float inHalfTurn(float y, int quadrant, uint32_t sign) {
  uint32_t isNotZero = (bitsOf(y) & ~floatSignBit) + ~floatSignBit; // in the sign's bit
  return floatOf(bitsOf(y) ^ (isNotZero & uint32_t(quadrant) << 30 & floatSignBit) ^ sign);
}

// ---- inverse trigonometric functions

/// atan(y/x) for 0 <= y <= x, 0 < x: the nearest of atan(0), atan(1/4) ... atan(1), and a series
/// for |t| <= 1/8 up to t^7/7.
inline float firstOctantAngle(float y, float x) {
  constexpr float angles[5] = {float(arcTangentTable[0].hi), float(arcTangentTable[4].hi),
                               float(arcTangentTable[8].hi), float(arcTangentTable[12].hi),
                               float(arcTangentTable[16].hi)};
  float ratio = y / x;
  int i = ratio < 1.0f ? int(fma(ratio, 4.0f, 0.5f)) : 4; // 4 for a NaN, too
  float c = 0.25f * float(i);
  float t = fma(-c, x, y) / fma(c, y, x);
  float z = t * t;
  float q = fma(z, -1.0f / 7, 1.0f / 5);
  q = fma(z, q, -1.0f / 3);
  return angles[i] + fma(t * z, q, t);
}

/// The angle of (x, y) for x, y >= 0, finite and not both 0.
inline float firstQuadrantAngle(float y, float x) {
  bool steep = y > x;
  float angle = firstOctantAngle(steep ? x : y, steep ? y : x);
  return steep ? float(halfPi.hi) - angle : angle;
}

// ---- rare cases

[[gnu::cold, gnu::const, gnu::noinline]] inline float specialPower(float x, float y) {
  return device::pow(x, y);
}
[[gnu::cold, gnu::const, gnu::noinline]] inline float specialSine(float x) {
  return device::sin(x);
}
[[gnu::cold, gnu::const, gnu::noinline]] inline float specialCosine(float x) {
  return device::cos(x);
}
[[gnu::cold, gnu::const, gnu::noinline]] inline float specialTangent(float x) {
  return device::tan(x);
}
[[gnu::cold, gnu::const, gnu::noinline]] inline float specialSineOfPi(float x) {
  return device::sinpi(x);
}
[[gnu::cold, gnu::const, gnu::noinline]] inline float specialCosineOfPi(float x) {
  return device::cospi(x);
}
[[gnu::cold, gnu::const, gnu::noinline]] inline float specialAngle(float y, float x) {
  return device::atan2(y, x);
}

} // namespace detail

/// e^x, relative error below 2^-23.
inline float exp(float x) {
  using namespace detail;
  if (!(absolute(x) < 105.0f)) // infinities and NaNs, too
    return x < 0.0f ? 0.0f : x + infinity();
  constexpr float first = 0x1.62ep-1f; // ln(2), its first 13 bits and the rest
  constexpr float second = float(ln2.hi - double(first));
  float k = nearest(x * float(inverseLn2.hi));
  return scale(exponentialSeries(fma(-k, second, fma(-k, first, x))), int(k));
}

/// 2^x, relative error below 2^-23.
inline float exp2(float x) {
  using namespace detail;
  if (!(absolute(x) < 151.0f))
    return x < 0.0f ? 0.0f : x + infinity();
  float k = nearest(x);
  return scale(exponentialSeries((x - k) * float(ln2.hi)), int(k));
}

/// ln(x), relative error below 2^-22.
inline float log(float x) {
  using namespace detail;
  if (!(x > 0.0f && x < infinity()))
    return logarithmOutside(x);
  Logarithm parts = logarithm(x);
  return fma(parts.exponent, float(ln2.hi), parts.ofM);
}

/// log2(x), relative error below 2^-22.
inline float log2(float x) {
  using namespace detail;
  if (!(x > 0.0f && x < infinity()))
    return logarithmOutside(x);
  Logarithm parts = logarithm(x);
  return fma(parts.ofM, float(inverseLn2.hi), parts.exponent);
}

/// x^y, relative error below 2^-21 (1 + |y log2 x|); special cases (x <= 0, infinities, NaNs) are
/// as in Elementary.h.
inline float pow(float x, float y) {
  using namespace detail;
  if (!(x > 0.0f && x < infinity() && absolute(y) < infinity()))
    return specialPower(x, y);
  return fast::exp2(y * fast::log2(x));
}

/// sin(x), relative error below 2^-22, absolute error below 2^-23. Its reduction has no branch, so
/// that the optimiser can share it with cos of the same argument.
inline float sin(float x) {
  using namespace detail;
  float a = absolute(x);
  bool isUsual = a < mostReduced;
  Quadrant reduced = reduce(isUsual ? a : 0.0f);
  float y = series(reduced.rest, (reduced.quadrant & 1) != 0);
  bool flips = ((reduced.quadrant & 2) != 0) != (bitsOf(x) >= floatSignBit);
  return isUsual ? withFlippedSign(y, flips) : specialSine(x);
}

/// cos(x), relative error below 2^-22, absolute error below 2^-23.
inline float cos(float x) {
  using namespace detail;
  float a = absolute(x);
  bool isUsual = a < mostReduced;
  Quadrant reduced = reduce(isUsual ? a : 0.0f);
  float y = series(reduced.rest, (reduced.quadrant & 1) == 0);
  return isUsual ? withFlippedSign(y, ((reduced.quadrant + 1) & 2) != 0) : specialCosine(x);
}

/// sin(pi x), relative error below 2^-22. Its reduction has no branch, so that the optimiser can
/// share it with cospi of the same argument.
inline float sinpi(float x) {
  using namespace detail;
  float a = absolute(x);
  bool isUsual = a < mostHalfTurns;
  Quadrant reduced = reduceHalfTurns(isUsual ? a : 0.0f);
  float y = series(reduced.rest, (reduced.quadrant & 1) != 0);
  uint32_t negative = bitsOf(x) & floatSignBit;
  return isUsual ? inHalfTurn(y, reduced.quadrant, negative) : specialSineOfPi(x);
}

/// cos(pi x), relative error below 2^-22.
inline float cospi(float x) {
  using namespace detail;
  float a = absolute(x);
  bool isUsual = a < mostHalfTurns;
  Quadrant reduced = reduceHalfTurns(isUsual ? a : 0.0f);
  float y = series(reduced.rest, (reduced.quadrant & 1) == 0);
  return isUsual ? inHalfTurn(y, reduced.quadrant + 1, 0) : specialCosineOfPi(x);
}

/// tan(x), relative error below 2^-21.
inline float tan(float x) {
  using namespace detail;
  float a = absolute(x);
  if (!(a < mostReduced))
    return specialTangent(x);
  Quadrant reduced = reduce(a);
  float sine = series(reduced.rest, false), cosine = series(reduced.rest, true);
  float y = (reduced.quadrant & 1) != 0 ? -cosine / sine : sine / cosine;
  return withFlippedSign(y, bitsOf(x) >= floatSignBit);
}

/// asin(x), relative error below 2^-21.
inline float asin(float x) {
  using namespace detail;
  float a = absolute(x);
  if (!(a <= 1.0f))
    return canonicalNaN();
  return withSignOf(firstQuadrantAngle(a, squareRoot((1.0f - a) * (1.0f + a))), x);
}

/// acos(x), relative error below 2^-21.
inline float acos(float x) {
  using namespace detail;
  float a = absolute(x);
  if (!(a <= 1.0f))
    return canonicalNaN();
  float angle = firstQuadrantAngle(squareRoot((1.0f - a) * (1.0f + a)), a);
  return x < 0.0f ? float(pi.hi) - angle : angle;
}

/// atan(x), relative error below 2^-22.
inline float atan(float x) {
  using namespace detail;
  float a = absolute(x);
  if (!(a < infinity()))
    return isNaN(x) ? canonicalNaN() : withSignOf(float(halfPi.hi), x);
  return withSignOf(firstQuadrantAngle(a, 1.0f), x);
}

/// The angle of (x, y), relative error below 2^-21; where a component is an infinity or a NaN, or
/// both are 0, too small or too large, it is that of Elementary.h.
inline float atan2(float y, float x) {
  using namespace detail;
  float a = absolute(x), b = absolute(y);
  float larger = a > b ? a : b, smaller = a > b ? b : a;
  if (!(larger >= 0x1p-100f && larger <= 0x1p100f && (smaller >= 0x1p-100f || smaller == 0.0f)))
    return specialAngle(y, x);
  float angle = firstQuadrantAngle(b, a);
  return withSignOf(x < 0.0f ? float(pi.hi) - angle : angle, y);
}

/// 1/sqrt(x), relative error below 2^-23.
inline float inversesqrt(float x) {
  using namespace detail;
  return 1.0f / squareRoot(x);
}

} // namespace rtsl::device::fast
