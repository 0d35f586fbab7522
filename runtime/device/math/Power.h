// pow.
//
//     x^y = e^(y ln x), with ln x to 2^-65 so that the exponent, which may be as large as 104, is
//     good to 2^-58.
//
// Error bound of the fast path: see docs/elementary-functions.md. Where the bound does not decide
// the rounding, x^y is either exactly a midpoint between floats, which exactPower() finds out, or
// it is computed again in double-double.
#pragma once

#include "runtime/device/math/DoubleDoubleFunctions.h"
#include "runtime/device/math/Rounding.h"

namespace rtsl::device {

namespace detail {

/// Relative error of e^fastPowerExponent(). roundsSafely() would bear 2^-53.
inline constexpr double powerBound = 0x1p-57;

/// ln(x) for a positive float x, relative error below 2^-65. Unlike logarithm(), the square term is
/// a double-double, too.
inline Double2 logarithmForPower(double x) {
  LogarithmReduction reduced = reduceLogarithm({x, 0.0});
  double r = reduced.r, exponent = reduced.exponent;
  double head = fma(exponent, ln2Parts[0], reduced.entry.hi); // exact
  Double2 linear = fastTwoSum(head, r);
  Double2 square = twoProduct(r, r);
  Double2 quadratic = fastTwoSum(linear.hi, -0.5 * square.hi);

  double q = fma(r, -1.0 / 10, 1.0 / 9);
  q = fma(r, q, -1.0 / 8);
  q = fma(r, q, 1.0 / 7);
  q = fma(r, q, -1.0 / 6);
  q = fma(r, q, 1.0 / 5);
  q = fma(r, q, -1.0 / 4);
  q = fma(r, q, 1.0 / 3);
  double low = fma(r * square.hi, q, fma(exponent, ln2Parts[1], reduced.entry.lo));
  low = fma(-0.5, square.lo, low) + (linear.lo + quadratic.lo);
  return fastTwoSum(quadratic.hi, low);
}

/// e^(hi + lo) for |hi| < 700, |lo| < 2^-40, relative error below 2^-59.
inline Double2 exponential(Double2 x) {
  ExponentialReduction reduced = reduceExponential(x.hi);
  double r = reduced.remainder;
  return scaledExponential(reduced.step, r + fma(x.lo, r, x.lo + exponentialCurvature(r)));
}

/// Whether x^y has 53 bits or fewer, for finite x > 0 and y != 0; `result` is then x^y. Needs no
/// more: every midpoint between floats has 25 bits or fewer.
///
/// A power with a finite binary expansion needs an x that is a square as often as y has binary
/// places (unless y < 0, when x is also a power of two); after that it is a product.
inline bool exactPower(double x, double y, double &result) {
  while (y != double(int64_t(y))) {
    double root = squareRoot(x);
    if (root * root != x || root == 1.0) // x has 24 bits, so that a rounded root cannot pass
      return false;
    x = root;
    y *= 2.0;
  }
  if (y < 0.0) {
    x = 1.0 / x; // exact for a power of two; any other x fails below, having 53 bits
    y = -y;
  }
  double power = 1.0;
  for (double i = 0.0; i < y; i += 1.0) {
    if (fma(power, x, -(power * x)) != 0.0)
      return false;
    power *= x;
  }
  result = power;
  return true;
}

/// y ln(x), relative error below 2^-65.
inline Double2 fastPowerExponent(double x, double y) {
  Double2 logarithm = logarithmForPower(x);
  Double2 exponent = twoProduct(y, logarithm.hi);
  return {exponent.hi, fma(y, logarithm.lo, exponent.lo)};
}

/// x^y in double-double, relative error below 2^-90, for -104 <= y ln x <= 89.
inline Double2 accuratePower(double x, double y) {
  return accurateExponential(multiply(accurateLogarithm(x), {y, 0.0}));
}

/// x^y for finite x > 0, x != 1, and finite y != 0.
inline float positivePower(double x, double y) {
  Double2 exponent = fastPowerExponent(x, y);
  if (exponent.hi > 89.0) // e^89 > 2^128
    return infinity();
  if (exponent.hi < -104.0) // e^-104 < 2^-150
    return 0.0f;
  float result;
  if (roundsSafely(exponential(exponent), result))
    return result;
  double exact;
  if (exactPower(x, y, exact))
    return float(exact);
  return roundToFloat(accuratePower(x, y));
}

enum class Parity { fraction, even, odd };

inline Parity parityOf(float y) {
  float a = absolute(y);
  if (a >= 0x1p24f) // infinity included
    return Parity::even;
  int truncated = int(a);
  if (float(truncated) != a)
    return Parity::fraction;
  return (truncated & 1) != 0 ? Parity::odd : Parity::even;
}

} // namespace detail

/// x^y, with the special cases of C99 (F.9.4.4): x^0 and 1^y are 1 even for a NaN, a negative x may
/// have an integer power, and
/// (-1)^(+-infinity) is 1.
inline float pow(float x, float y) {
  using namespace detail;
  if (y == 0.0f || x == 1.0f)
    return 1.0f;
  if (isNaN(x) || isNaN(y))
    return canonicalNaN();

  float a = absolute(x);
  Parity parity = parityOf(y);
  bool negative = bitsOf(x) >= floatSignBit && parity == Parity::odd;
  float sign = negative ? -1.0f : 1.0f;

  if (a == 0.0f || a == infinity())
    return withSignOf((a == 0.0f) == (y < 0.0f) ? infinity() : 0.0f, sign);
  if (absolute(y) == infinity())
    return a == 1.0f ? 1.0f : (a < 1.0f) == (y < 0.0f) ? infinity() : 0.0f;
  if (x < 0.0f && parity == Parity::fraction)
    return canonicalNaN();
  if (a == 1.0f)
    return sign;
  return withSignOf(positivePower(a, y), sign);
}

} // namespace rtsl::device
