// sqrt and inversesqrt.
#pragma once

#include "math/kernels/Rounding.h"

namespace rtsl::device {

/// The IEEE square root.
inline float sqrt(float x) {
  using namespace detail;
  // Tests the bits, because LLVM removes a select between a NaN and sqrt(x) that depends on x < 0:
  // it treats all NaNs as equal.
  uint32_t bits = bitsOf(x);
  if (bits > floatInfinityBits && bits != floatSignBit)
    return canonicalNaN();
  return squareRoot(x);
}

/// 1/sqrt(x). Like C's rSqrt of TS 18661-4: infinity with the sign of a zero, zero at infinity, NaN
/// below zero.
inline float inversesqrt(float x) {
  using namespace detail;
  if (x == 0.0f)
    return withSignOf(infinity(), x);
  if (!(x > 0.0f))
    return canonicalNaN();
  if (x == infinity())
    return 0.0f;
  double a = x;
  double y = 1.0 / squareRoot(a);
  Double2 square = twoProduct(y, y);
  double residual = fma(-a, square.lo, fma(-a, square.hi, 1.0)); // 1 - a y^2
  return roundToFloat({y, 0.5 * y * residual});                  // one step of Newton's iteration
}

} // namespace rtsl::device
