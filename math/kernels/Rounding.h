// The last step of every function: from a double, or a sum of two, to the nearest float.
#pragma once

#include "math/kernels/DoubleDouble.h"

namespace rtsl::device::detail {

/// roundToFloat() where the double nearest to the sum may be midway between two floats.
[[gnu::cold, gnu::noinline]] inline float roundFromMidpoint(Double2 y) {
  Double2 sum = normalized(y);
  uint64_t bits = bitsOf(sum.hi);
  if (sum.lo != 0.0)
    bits = (sum.lo > 0.0) == (sum.hi > 0.0) ? bits + 1 : bits - 1;
  return float(doubleOf(bits));
}

/// Rounds hi + lo to float as if the sum were exact; |hi| >= |lo|.
///
/// float(hi + lo) would round twice, which goes wrong only where the double nearest to the sum is
/// itself midway between two floats. Such a double ends in 28 zeros (more below the normal floats);
/// moving it by its last bit towards the sum decides. Elsewhere the sum and the double nearest to
/// it lie on the same side of every midpoint, because midpoints are doubles. (Boldo and Melquiond,
/// "Emulation of a FMA and correctly rounded sums", IEEE Trans. Computers 57(4), 2008, do the same
/// by rounding to odd.)
inline float roundToFloat(Double2 y) {
  double nearest = y.hi + y.lo;
  if ((bitsOf(nearest) & 0x0fffffffu) != 0)
    return float(nearest);
  return roundFromMidpoint(y);
}

/// The margin of roundsSafely(), relative: two last places of a double or more.
inline constexpr double roundingMargin = 0x1p-51;

/// Rounds a number that is known to be hi + lo within a relative error of 2^-53, to float. Returns
/// whether that is certain (Ziv, ACM TOMS 17(3), 1991), which it is but for about one number in
/// 2^26.
///
/// Both ends of an interval around the number must round to the same float. The margin is wide
/// enough that if the number is next to a midpoint, the doubles nearest to the ends lie on either
/// side of it.
inline bool roundsSafely(Double2 y, float &result) {
  double margin = absolute(y.hi) * roundingMargin;
  result = float(y.hi + (y.lo + margin));
  return result == float(y.hi + (y.lo - margin));
}

/// The relative error that roundsSafely(double) permits.
inline constexpr double plainBound = 0x1p-44;
/// At least twice that in last places of a double, so that its own rounding does not matter.
inline constexpr uint64_t plainMargin = uint64_t(1) << 10;

/// The last 29 bits of a double midway between two floats.
inline constexpr uint64_t roundingMidpoint = uint64_t(1) << 28;

/// Whether a number within plainBound of y rounds to float(y), for a y that is zero or normal as a
/// float, or exact. It does unless y is near a midpoint between floats, as about one number in 2^18
/// is.
inline bool roundsSafely(double y) {
  uint64_t distance = bitsOf(y) - (roundingMidpoint - plainMargin);
  return (distance & (2 * roundingMidpoint - 1)) > 2 * plainMargin;
}

} // namespace rtsl::device::detail
