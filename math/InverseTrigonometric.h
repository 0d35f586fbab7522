// asin, acos and atan.
#pragma once

#include "math/kernels/ArcTangentKernel.h"
#include "math/kernels/Rounding.h"

namespace rtsl::device {

namespace detail {

/// sqrt(1 - x^2) for 0 <= x <= 1.
inline Double2 otherLeg(double x) {
  double square = fma(-x, x, 1.0);
  return square > 0.0 ? squareRootOf(square) : Double2{0.0, 0.0};
}

} // namespace detail

/// Arc sine, in [-pi/2, pi/2]. NaN outside [-1, 1].
inline float asin(float x) {
  using namespace detail;
  float a = absolute(x);
  if (!(a <= 1.0f))
    return canonicalNaN();
  Double2 y = firstQuadrantAngle({a, 0.0}, otherLeg(a));
  return withSignOf(roundToFloat(y), x);
}

/// Arc cosine, in [0, pi]. NaN outside [-1, 1].
inline float acos(float x) {
  using namespace detail;
  float a = absolute(x);
  if (!(a <= 1.0f))
    return canonicalNaN();
  Double2 y = firstQuadrantAngle(otherLeg(a), {a, 0.0});
  if (x < 0.0f)
    y = complement(pi, y);
  return roundToFloat(y);
}

/// Arc tangent of one argument, in [-pi/2, pi/2].
inline float atan(float x) {
  using namespace detail;
  if (isNaN(x))
    return canonicalNaN();
  float a = absolute(x);
  if (a == infinity())
    return withSignOf(float(halfPi.hi), x);
  Double2 y = firstQuadrantAngle({a, 0.0}, {1.0, 0.0});
  return withSignOf(roundToFloat(y), x);
}

} // namespace rtsl::device
