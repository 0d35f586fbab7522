// atan2.
//
// Error bound of the fast path: see docs/elementary-functions.md. Where the bound does not decide
// the rounding, the angle is computed again in double-double.
#pragma once

#include "math/kernels/DoubleDoubleFunctions.h"
#include "math/kernels/Rounding.h"

namespace rtsl::device {

namespace detail {

/// Relative error of fastAngle(). roundsSafely() permits 2^-53.
inline constexpr double arcTangent2Bound = 0x1p-60;

/// The angle of (x, y), or of (-x, y) if `isLeft`, for finite x, y >= 0 that are not both zero.
inline Double2 fastAngle(double y, double x, bool isLeft) {
  Double2 angle = firstQuadrantAngle({y, 0.0}, {x, 0.0});
  return isLeft ? complement(pi, angle) : angle;
}

/// The same with a relative error below 2^-90.
inline Double2 accurateAngle(double y, double x, bool isLeft) {
  Double2 angle =
      y <= x ? accurateFirstOctantAngle(y, x) : add(halfPi, negate(accurateFirstOctantAngle(x, y)));
  return isLeft ? add(pi, negate(angle)) : angle;
}

inline float roundedAngle(double y, double x, bool isLeft) {
  if (!isLeft && y < x * 0x1p-27) {
    // atan(q) = q (1 - q^2/3 + ...) is between q (1 - 2^-54) and q. The quotient q of two floats
    // either is a midpoint between floats, which occurs below the normal floats, or is at least
    // 2^-50 away from one; so moving it slightly towards zero decides.
    double q = y / x;
    return float(fma(q, -0x1p-52, q));
  }
  float result;
  if (roundsSafely(fastAngle(y, x, isLeft), result))
    return result;
  return roundToFloat(accurateAngle(y, x, isLeft));
}

} // namespace detail

/// The angle of the point (x, y) in [-pi, pi]; signed zeros and infinities as in C99 (F.9.1.4).
/// GLSL calls this atan(y, x).
inline float atan2(float y, float x) {
  using namespace detail;
  if (isNaN(x) || isNaN(y))
    return canonicalNaN();
  float height = absolute(y), width = absolute(x);
  bool isLeft = bitsOf(x) >= floatSignBit;
  if (height == 0.0f && width == 0.0f)
    width = 1.0f; // the sign of the zero x still selects 0 or pi
  if (height == infinity() || width == infinity()) {
    // Like a point on an axis, or on the diagonal.
    bool both = height == width;
    height = both || height == infinity() ? 1.0f : 0.0f;
    width = both || width == infinity() ? 1.0f : 0.0f;
  }
  return withSignOf(roundedAngle(height, width, isLeft), y);
}

} // namespace rtsl::device
