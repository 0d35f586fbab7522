// The last step of every function: from a double, or a sum of two, to the nearest float.
#pragma once

#include "runtime/device/math/DoubleDouble.h"

namespace rtsl::device::detail {

/// A float for which the double result, though accurate, lies on the wrong side of the point midway
/// between two floats.
struct Exception {
  uint32_t argument, result;
};

/// Rounds `y`, the double approximation of f(x), to float; `exceptions` are those of f. `x` must be
/// what the table's arguments are: |x| for functions that are computed on |x|.
///
/// A rounding can only fail where y is within a few double ulps of a midpoint, so that the table is
/// read once in about ten million calls. (Results below the smallest normal float have their
/// midpoints elsewhere; no function has an exception there, which the exhaustive test proves.)
template <int count>
inline float roundToFloat(double y, float x, const Exception (&exceptions)[count]) {
  constexpr uint32_t discarded = 0x1fffffffu; // the 29 bits that a float's significand lacks
  constexpr uint32_t midpoint = 0x10000000u, window = 16;
  uint32_t distance = (uint32_t(bitsOf(y)) & discarded) - (midpoint - window);
  if (distance <= 2 * window)
    for (const Exception &exception : exceptions)
      if (bitsOf(x) == exception.argument)
        return floatOf(exception.result);
  return float(y);
}

/// Rounds hi + lo to float, where the sum is taken for exact.
///
/// hi + lo is first rounded to odd: to 53 bits, of which the last is set if anything was cut off.
/// Rounding that to nearest is as good as rounding hi + lo itself, because a float has at least two
/// bits fewer (Boldo and Melquiond, "Emulation of a FMA and correctly rounded sums", IEEE Trans.
/// Computers 57(4), 2008).
inline float roundToFloat(Double2 y) {
  Double2 sum = fastTwoSum(y.hi, y.lo);
  uint64_t bits = bitsOf(sum.hi);
  bool inexact = sum.lo != 0.0, even = (bits & 1) == 0;
  if (inexact && even) {
    bool awayFromZero = (sum.lo > 0.0) == (sum.hi > 0.0);
    bits = awayFromZero ? bits + 1 : bits - 1;
  }
  return float(doubleOf(bits));
}

/// Rounds hi + lo, known up to a relative error `bound`, to float. Returns whether that is certain:
/// whether everything between (hi + lo)(1 - bound) and (hi + lo)(1 + bound) rounds to the same
/// float (Ziv, ACM TOMS 17(3), 1991).
inline bool roundsSafely(Double2 y, double bound, float &result) {
  double margin = absolute(y.hi) * bound;
  result = roundToFloat(Double2{y.hi, y.lo - margin});
  return bitsOf(result) == bitsOf(roundToFloat(Double2{y.hi, y.lo + margin}));
}

} // namespace rtsl::device::detail
