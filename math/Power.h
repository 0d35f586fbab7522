// pow.
//
//     x^y = e^(y ln x), in plain double: the exponent, which may be as large as 104, is good to
//     2^-44.6, and so is the power.
//
// Error bound of this first path: see docs/elementary-functions.md. Where the bound does not decide
// the rounding, about one time in 2^18, x^y is either exactly a midpoint between floats, which
// exactPower() finds out, or it is computed again in double-double.
#pragma once

#include "math/kernels/DoubleDoubleFunctions.h"
#include "math/kernels/ExponentialKernel.h"
#include "math/kernels/LogarithmKernel.h"
#include "math/kernels/Rounding.h"

namespace rtsl::device {

namespace detail {

/// y ln(x) for a positive float x, relative error below 2^-50.9.
inline double exponentOfPower(float x, double y) {
  LogarithmReduction reduced =
      isPositiveNormal(x) ? reduceLogarithmOfNormal(x) : reduceLogarithm({x, 0.0});
  return y * plainLogarithm(reduced, reduced.exponent);
}

/// Whether x^y has 53 bits or fewer, for finite x > 0 and y != 0; `result` is then x^y. Needs no
/// more: every midpoint between floats has 25 bits or fewer.
///
/// x^y has a finite binary expansion only if an exact square root can be taken of x, and again of
/// the result, once for each binary place of y; if y < 0, x must also be a power of two. What
/// remains is an integer power, which is a product.
inline bool exactPower(double x, double y, double &result) {
  while (y != double(int64_t(y))) {
    double root = squareRoot(x);
    if (root * root != x || root == 1.0) // the square of a rounded root is not x, which has 24 bits
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

/// x^y in double-double, relative error below 2^-90, for -104 <= y ln x <= 89.
inline Double2 accuratePower(double x, double y) {
  return accurateExponential(multiply(accurateLogarithm(x), {y, 0.0}));
}

/// x^y if plain double does not decide, or the result is subnormal or zero.
[[gnu::cold, gnu::const, gnu::noinline]] inline float carefulPower(double x, double y,
                                                                   double exponent) {
  if (exponent < -104.0) // e^-104 < 2^-150
    return 0.0f;
  double exact;
  if (exactPower(x, y, exact))
    return float(exact);
  return roundToFloat(accuratePower(x, y));
}

/// x^y for finite x > 0 and finite y; `exponent` is y ln(x). On the host a separate function:
/// otherwise `pow` would not be small enough to be inlined, with its logarithm, where x is a
/// constant.
#ifndef __NVPTX__
[[gnu::const, gnu::noinline]]
#endif
inline float powerOfExponent(double x, double y, double exponent) {
  if (exponent > 89.0) // e^89 > 2^128
    return infinity();
  if (exponent < -87.0) // e^-87 > 2^-126
    return carefulPower(x, y, exponent);
  double power = plainExponential(exponent);
  return roundsSafely(power) ? float(power) : carefulPower(x, y, exponent);
}

[[gnu::always_inline]] inline float positivePower(float x, float y) {
  return powerOfExponent(x, y, exponentOfPower(x, y));
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

/// pow() of zero, subnormal, negative and infinite numbers and NaN.
[[gnu::cold, gnu::const, gnu::noinline]] inline float specialPower(float x, float y) {
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
  return withSignOf(positivePower(a, y), sign);
}

} // namespace detail

/// x^y, with the special cases of C99 (F.9.4.4): x^0 and 1^y are 1 even for a NaN, a negative x may
/// have an integer power, and (-1)^(+-infinity) is 1.
[[gnu::always_inline]] inline float pow(float x, float y) {
  using namespace detail;
  if (isPositiveNormal(x) && absolute(y) < infinity())
    return positivePower(x, y);
  return specialPower(x, y);
}

} // namespace rtsl::device
