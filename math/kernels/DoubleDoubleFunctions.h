// e^x, ln x and angles to about 2^-100: the last step of pow and atan2, needed about once in 10^9
// calls. Short, not fast.
#pragma once

#include "math/kernels/ArcTangentKernel.h"
#include "math/kernels/ExponentialKernel.h"
#include "math/kernels/LogarithmKernel.h"

namespace rtsl::device::detail {

/// integer * (the sum of three parts), where the product with the first part is exact.
inline Double2 multiplyByParts(double integer, const double (&parts)[3]) {
  Double2 high = {integer * parts[0], 0.0};
  Double2 middle = twoProduct(integer, parts[1]);
  return add(add(high, middle), {integer * parts[2], 0.0});
}

/// ln(x) for a positive float x, relative error below 2^-98: with x = 2^k m and
/// s = (m - 1)/(m + 1), ln(m) = 2 (s + s^3/3 + s^5/5 + ...). |s| <= 5/27, so that the error of 24
/// terms is below 2^-119 |s|.
inline Double2 accurateLogarithm(double x) {
  uint64_t distance = bitsOf(x) - bitsOf(0.6875);
  int exponent = int(int64_t(distance) >> 52);
  double m = x * powerOfTwo(-exponent);
  Double2 s = divide({m - 1.0, 0.0}, {m + 1.0, 0.0}); // both exact: m has 24 bits
  Double2 z = multiply(s, s);
  Double2 sum = {0.0, 0.0};
  for (int n = 47; n >= 1; n -= 2)
    sum = add(multiply(sum, z), divide({1.0, 0.0}, {double(n), 0.0}));
  Double2 fraction = multiply(s, sum);
  return add(multiplyByParts(exponent, ln2Parts), {2.0 * fraction.hi, 2.0 * fraction.lo});
}

/// e^x for |x| < 700, relative error below 2^-98 for exact x. Taylor's series up to r^13/13!, |r|
/// <= ln(2)/128, leaves less than 2^-140.
inline Double2 accurateExponential(Double2 x) {
  int step = reduceExponential(x.hi).step;
  Double2 r = add(x, negate(multiplyByParts(step, exponentialStep)));
  Double2 sum = {1.0, 0.0};
  for (int n = 13; n >= 1; --n)
    sum = add({1.0, 0.0}, multiply(multiply(r, sum), divide({1.0, 0.0}, {double(n), 0.0})));
  ExponentialEntry entry = exponentialTable[step & (exponentialTableSize - 1)];
  Double2 y = multiply({entry.hi, entry.lo}, sum);
  double scale = powerOfTwo(step >> 6);
  return {scale * y.hi, scale * y.lo};
}

/// atan(y/x) for floats 0 <= y <= x, 0 < x, relative error below 2^-98. Taylor's series up to
/// t^25/25 leaves less than 2^-138 |t|.
inline Double2 accurateFirstOctantAngle(double y, double x) {
  ArcTangentReduction reduced = reduceArcTangent({y, 0.0}, {x, 0.0});
  ArcTangentEntry entry = arcTangentTable[reduced.index];
  Double2 t = divide(reduced.numerator, reduced.denominator);
  Double2 z = negate(multiply(t, t));
  Double2 sum = {0.0, 0.0};
  for (int n = 25; n >= 1; n -= 2)
    sum = add(multiply(sum, z), divide({1.0, 0.0}, {double(n), 0.0}));
  return add({entry.hi, entry.lo}, multiply(t, sum));
}

} // namespace rtsl::device::detail
