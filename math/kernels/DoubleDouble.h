// Unevaluated sums of two doubles ("double-double"): about 106 bits from ordinary double
// arithmetic.
//
// Error bounds: Joldes, Muller, Popescu, "Tight and rigorous error bounds for basic building blocks
// of double-word arithmetic", ACM TOMS 44(2), 2017. With u = 2^-53, add() has a relative error
// below 4 u^2, multiply() below 6 u^2, divide() below 16 u^2.
#pragma once

#include "math/kernels/Bits.h"

namespace rtsl::device::detail {

/// The number hi + lo, where |lo| is at most half a unit in the last place of hi (or a little more
/// where stated).
struct Double2 {
  double hi, lo;
};

/// a + b without error, for |a| >= |b| or a = 0 (Dekker 1971).
inline Double2 fastTwoSum(double a, double b) {
  double sum = a + b;
  return {sum, b - (sum - a)};
}

/// a + b without error (Knuth, TAOCP 2, section 4.2.2; Moller 1965).
inline Double2 twoSum(double a, double b) {
  double sum = a + b;
  double bRounded = sum - a;
  double aRounded = sum - bRounded;
  return {sum, (a - aRounded) + (b - bRounded)};
}

/// The same number with |lo| at most half a unit in the last place of hi, for |hi| >= |lo|.
inline Double2 normalized(Double2 a) {
  return fastTwoSum(a.hi, a.lo);
}

/// a * b without error, unless it underflows.
inline Double2 twoProduct(double a, double b) {
  double product = a * b;
  return {product, fma(a, b, -product)};
}

inline Double2 negate(Double2 a) {
  return {-a.hi, -a.lo};
}

inline Double2 half(Double2 a) {
  return {0.5 * a.hi, 0.5 * a.lo};
}

inline Double2 add(Double2 a, Double2 b) {
  Double2 high = twoSum(a.hi, b.hi);
  Double2 low = twoSum(a.lo, b.lo);
  Double2 sum = fastTwoSum(high.hi, high.lo + low.hi);
  return fastTwoSum(sum.hi, sum.lo + low.lo);
}

inline Double2 multiply(Double2 a, Double2 b) {
  Double2 product = twoProduct(a.hi, b.hi);
  return fastTwoSum(product.hi, product.lo + fma(a.hi, b.lo, a.lo * b.hi));
}

inline Double2 divide(Double2 a, Double2 b) {
  // Newton's step on the quotient of the high parts; the remainder of the division is exact but for
  // its own low parts.
  double inverse = 1.0 / b.hi;
  double quotient = a.hi * inverse;
  Double2 product = multiply({quotient, 0.0}, b);
  double remainder = (a.hi - product.hi) - product.lo + a.lo;
  Double2 first = fastTwoSum(quotient, remainder * inverse);
  product = multiply(first, b);
  Double2 rest = add(a, negate(product));
  return fastTwoSum(first.hi, fma(rest.hi, inverse, first.lo));
}

/// a / b for normalized a and b, to about 2^-100 but without divide()'s last step: one division, a
/// relative error below 2^-98 * 4.
inline Double2 quotient(Double2 a, Double2 b) {
  double inverse = 1.0 / b.hi;
  double first = a.hi * inverse;
  double remainder = fma(-first, b.lo, fma(-first, b.hi, a.hi) + a.lo);
  return {first, remainder * inverse};
}

/// The square root of a (> 0), to about 2^-104.
inline Double2 squareRootOf(double a) {
  double root = squareRoot(a);
  return fastTwoSum(root, fma(-root, root, a) / (root + root));
}

} // namespace rtsl::device::detail
