// ln(x) in double with a low part: what the logarithms and the inverse hyperbolic functions have in
// common.
//
// Table-driven as in Tang, "Table-driven implementation of the logarithm function", ACM TOMS 16(4),
// 1990, with the table's reciprocals so short that the reduced argument is exact:
//     x = 2^k m,  11/16 <= m < 11/8
//     m * inverse = 1 + r,  |r| < 2^-7
//     ln x = k ln 2 - ln(inverse) + ln(1 + r)
#pragma once

#include "math/kernels/DoubleDouble.h"
#include "math/tables/Constants.h"
#include "math/tables/LogarithmTable.h"

namespace rtsl::device::detail {

/// ln(x) = exponent * ln(2) + (entry.hi + entry.lo) + ln(1 + r + rLow).
struct LogarithmReduction {
  int exponent;
  LogarithmEntry entry;
  double r, rLow;
};

/// For positive x, normal as doubles (all floats are). r is exact if x.hi has 40 bits or fewer.
inline LogarithmReduction reduceLogarithm(Double2 x) {
  // The doubles from 11/16 to 11/8 are 2^52 consecutive bit patterns, so that the distance from
  // 11/16 contains both the exponent and, in the seven bits below it, the table's cell.
  uint64_t distance = bitsOf(x.hi) - bitsOf(0.6875);
  int exponent = int(int64_t(distance) >> 52);
  LogarithmEntry entry = logarithmTable[(distance >> 45) & 127];
  double mantissa = doubleOf(bitsOf(x.hi) - (distance >> 52 << 52));
  return {exponent, entry, fma(mantissa, entry.inverse, -1.0),
          x.lo * powerOfTwo(-exponent) * entry.inverse};
}

/// (ln(1 + r) - r) / r^2 by Taylor's series, in independent pairs of terms. `rest` has the
/// coefficients from r^4 on.
inline double logarithmCurvature(double r, double square, double rest) {
  double q = fma(square, rest, fma(r, 1.0 / 5, -1.0 / 4));
  return fma(square, q, fma(r, 1.0 / 3, -1.0 / 2));
}

/// The natural logarithm of 2^(exponent) times the reduced number, relative error about 2^-59. For
/// |r| < 2^-7 the series leaves out less than 2^-59 |r|.
inline Double2 logarithm(const LogarithmReduction &x, int exponent) {
  double head = fma(double(exponent), ln2Parts[0], x.entry.hi); // exact
  Double2 sum = fastTwoSum(head, x.r);
  double square = x.r * x.r;
  double rest = fma(square, -1.0 / 8, fma(x.r, 1.0 / 7, -1.0 / 6));
  double low = fma(-x.r, x.rLow, x.rLow) + square * logarithmCurvature(x.r, square, rest);
  low += fma(double(exponent), ln2Parts[1], x.entry.lo);
  return {sum.hi, sum.lo + low};
}

/// The reduction of a positive normal float by its own bits, with less latency than by those of a
/// double; rLow is 0.
inline LogarithmReduction reduceLogarithmOfNormal(float x) {
  uint32_t distance = bitsOf(x) - bitsOf(0.6875f);
  LogarithmEntry entry = logarithmTable[(distance >> 16) & 127];
  double mantissa = floatOf(bitsOf(x) - (distance >> 23 << 23));
  return {int(distance) >> 23, entry, fma(mantissa, entry.inverse, -1.0), 0.0};
}

/// exponent * ln(2) + (hi + lo) + ln(1 + r) in plain double, relative error below 2^-51.3. The
/// series leaves out less than 2^-52 |r|; its terms are summed with few dependencies. `Real` is
/// double or DoubleLanes.
template <typename Real>
inline Real plainLogarithm(Real exponent, Real hi, Real lo, Real r) {
  Real head = fma(exponent, ln2Parts[0], hi); // exact
  Real low = fma(exponent, ln2Parts[1], lo);
  Real square = r * r;
  Real first = fma(square, fma(r, 1.0 / 3, -1.0 / 2), low);
  Real rest = fma(square, fma(r, 1.0 / 7, -1.0 / 6), fma(r, 1.0 / 5, -1.0 / 4));
  return head + (r + fma(square * square, rest, first));
}

/// The same for a reduced number, without rLow.
inline double plainLogarithm(const LogarithmReduction &x, double exponent) {
  return plainLogarithm<double>(exponent, x.entry.hi, x.entry.lo, x.r);
}

/// exponent * ln(2) + ln(1 + r) for a float to come, relative error below 2^-44.7: the series
/// leaves out less than r^6 / 7 < 2^-44.8 of r. `head` is far from -r wherever it is not 0, so that
/// their sum may be rounded before the rest is there.
inline double quickLogarithm(const LogarithmReduction &x, double exponent) {
  double head = fma(exponent, ln2Parts[0], x.entry.hi); // exact
  double low = fma(exponent, ln2Parts[1], x.entry.lo);
  double square = x.r * x.r;
  double first = fma(square, fma(x.r, 1.0 / 3, -1.0 / 2), low);
  double rest = fma(square, -1.0 / 6, fma(x.r, 1.0 / 5, -1.0 / 4));
  return (head + x.r) + fma(square * square, rest, first);
}

/// ln(x) for positive x = hi + lo.
inline Double2 naturalLogarithm(Double2 x) {
  LogarithmReduction reduced = reduceLogarithm(x);
  return logarithm(reduced, reduced.exponent);
}

/// ln(1 + t) for t > -1, accurate near zero.
inline Double2 naturalLogarithmOfOnePlus(Double2 t) {
  Double2 sum = twoSum(1.0, t.hi);
  return naturalLogarithm({sum.hi, sum.lo + t.lo});
}

/// log2(x) for positive x.
inline Double2 binaryLogarithm(double x) {
  LogarithmReduction reduced = reduceLogarithm({x, 0.0});
  Double2 fraction = multiply(normalized(logarithm(reduced, 0)), inverseLn2);
  Double2 sum = fastTwoSum(double(reduced.exponent), fraction.hi); // |fraction| < 0.6
  return {sum.hi, sum.lo + fraction.lo};
}

} // namespace rtsl::device::detail
