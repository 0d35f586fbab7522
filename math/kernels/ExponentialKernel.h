// e^x in double with a low part, shared by exp, exp2, expm1, the hyperbolic functions and pow.
//
// Table-driven as in Tang, "Table-driven implementation of the exponential function", ACM TOMS
// 15(2), 1989:
//     x = (64 k + j) ln(2)/64 + r,  |r| <= ln(2)/128,      e^x = 2^k * 2^(j/64) * e^r.
#pragma once

#include "math/kernels/DoubleDouble.h"
#include "math/tables/Constants.h"
#include "math/tables/ExponentialTable.h"

namespace rtsl::device::detail {

inline constexpr double exponentialStepsPerUnit = exponentialTableSize * inverseLn2.hi;
inline constexpr double exponentialStepSize = ln2.hi / exponentialTableSize; // ln(2)/64 to 2^-54

/// x = step * ln(2)/64 + remainder, with |remainder| <= ln(2)/128 (a little more after rounding).
struct ExponentialReduction {
  int step;
  double remainder;
};

/// For |x| < 700. The remainder's relative error is below 2^-52.
inline ExponentialReduction reduceExponential(double x) {
  NearestInteger step = nearestInteger(x * exponentialStepsPerUnit);
  double remainder = fma(-step.asDouble, exponentialStep[0],
                         x); // exact: the product is, and then Sterbenz's lemma
  return {step.asInt, fma(-step.asDouble, exponentialStep[1], remainder)};
}

/// e^r - 1 - r for |r| <= 0.0055, by Taylor's series, in pairs of terms that do not wait for each
/// other. What is left out is below r^7/5040 < 2^-64.
inline double exponentialCurvature(double r) {
  double square = r * r;
  double q = fma(square, 1.0 / 720, fma(r, 1.0 / 120, 1.0 / 24));
  q = fma(square, q, fma(r, 1.0 / 6, 0.5));
  return square * q;
}

/// e^r - 1 in plain double for |r| <= 0.0055. What is left out is below r^6/720 < 2^-54. `Real` is
/// double or DoubleLanes.
template <typename Real>
inline Real plainExponentialTail(Real r) {
  Real square = r * r;
  Real q = fma(square, fma(r, 1.0 / 120, 1.0 / 24), fma(r, 1.0 / 6, 0.5));
  return fma(square, q, r);
}

/// 2^(step/64) * (1 + tail) in plain double; a relative error of 2^-52 beside the tail's.
inline double plainScaledExponential(int step, double tail) {
  double entry = exponentialTable[step & (exponentialTableSize - 1)].hi;
  return powerOfTwo(step >> 6) * fma(entry, tail, entry);
}

/// e^x in plain double for |x| < 104: the step's size is good to 2^-54, so that the remainder's
/// error, and the relative one of the result, is below 2^-47.
inline double plainExponential(double x) {
  NearestInteger step = nearestInteger(x * exponentialStepsPerUnit);
  return plainScaledExponential(step.asInt,
                                plainExponentialTail(fma(-step.asDouble, exponentialStepSize, x)));
}

/// e^r - 1.
inline double exponentialTail(double r) {
  return r + exponentialCurvature(r);
}

/// 2^(step/64) * (1 + tail) = hi + lo, where |lo| <= |hi|/150 and the relative error of the sum is
/// below 2^-59 plus that of the tail times |tail|. Step/64 within the exponents of normal doubles.
inline Double2 scaledExponential(int step, double tail) {
  ExponentialEntry entry = exponentialTable[step & (exponentialTableSize - 1)];
  double scale = powerOfTwo(step >> 6);
  return {scale * entry.hi, scale * fma(entry.hi, tail, entry.lo)};
}

/// e^x for |x| < 700.
inline Double2 exponential(double x) {
  ExponentialReduction reduced = reduceExponential(x);
  return scaledExponential(reduced.step, exponentialTail(reduced.remainder));
}

} // namespace rtsl::device::detail
