// The angle of a point (x, y): what asin, acos, atan and atan2 have in common.
//
//     y/x = c + a small rest,  c = i/16
//     atan(y/x) = atan(c) + atan(t),  t = (y - c x)/(x + c y),  |t| < 0.032
//
// One table of 17 angles and a short series; no separate polynomials for asin and acos, which are
// angles of the points (sqrt(1 - x^2), x) and (x, sqrt(1 - x^2)).
#pragma once

#include "math/kernels/DoubleDouble.h"
#include "math/tables/ArcTangentTable.h"
#include "math/tables/Constants.h"

namespace rtsl::device::detail {

/// atan(y/x) as the table's angle of c = index/16 and the arc tangent of numerator/denominator.
struct ArcTangentReduction {
  int index;
  Double2 numerator, denominator;
};

/// For 0 <= y <= x, 0 < x. Numerator and denominator are exact if y and x are floats.
inline ArcTangentReduction reduceArcTangent(Double2 y, Double2 x) {
  // Single precision is enough to choose c. The quotient is at most 1 (rounding is monotonic).
  int index = int(float(y.hi) / float(x.hi) * 16.0f + 0.5f);
  double c = index * 0.0625;
  return {
      index, {fma(-c, x.hi, y.hi), fma(-c, x.lo, y.lo)}, {fma(c, y.hi, x.hi), fma(c, y.lo, x.lo)}};
}

/// atan(t) - t for |t| < 0.032, by Taylor's series up to t^11/11. What is left out is below 2^-63
/// |t|.
inline double arcTangentCurvature(double t) {
  double z = t * t;
  double q = fma(z, -1.0 / 11, 1.0 / 9);
  q = fma(z, q, -1.0 / 7);
  q = fma(z, q, 1.0 / 5);
  q = fma(z, q, -1.0 / 3);
  return t * z * q;
}

/// atan(y/x) for 0 <= y <= x, 0 < x.
inline Double2 firstOctantAngle(Double2 y, Double2 x) {
  ArcTangentReduction reduced = reduceArcTangent(y, x);
  ArcTangentEntry entry = arcTangentTable[reduced.index];
  Double2 n = reduced.numerator, d = reduced.denominator;
  double inverse = 1.0 / d.hi;
  double t = n.hi * inverse;
  double tLow = fma(-t, d.lo, fma(-t, d.hi, n.hi) + n.lo) * inverse;
  Double2 sum = fastTwoSum(entry.hi, t);
  return {sum.hi, sum.lo + (entry.lo + (tLow + arcTangentCurvature(t)))};
}

/// whole - part, for |whole| >= |part|.
inline Double2 complement(Double2 whole, Double2 part) {
  Double2 head = fastTwoSum(whole.hi, -part.hi);
  return {head.hi, head.lo + (whole.lo - part.lo)};
}

/// The angle from the x axis to (x, y), for x, y >= 0 and not both 0.
inline Double2 firstQuadrantAngle(Double2 y, Double2 x) {
  bool steep = y.hi > x.hi;
  Double2 angle = firstOctantAngle(steep ? x : y, steep ? y : x);
  return steep ? complement(halfPi, angle) : angle;
}

} // namespace rtsl::device::detail
