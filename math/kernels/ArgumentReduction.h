// x = q pi/2 + r, |r| <= pi/4, for every float x >= 0: the first half of sin, cos and tan.
#pragma once

#include "math/kernels/DoubleDouble.h"
#include "math/tables/Constants.h"

namespace rtsl::device::detail {

/// The quadrant q modulo 4 and the rest r. No float but zero lies closer than 2^-32 to a multiple
/// of pi/2, relative to pi/2, so that r keeps a small relative error.
struct QuadrantReduction {
  int quadrant;
  Double2 rest;
};

/// For 0 <= x < 2^19, with pi/2 in three parts (Cody and Waite, Software Manual for the Elementary
/// Functions, 1980). The first product and difference are exact.
inline QuadrantReduction reduceModerate(double x) {
  NearestInteger q = nearestInteger(x * twoOverPi);
  double first = fma(-q.asDouble, halfPiParts[0], x);
  Double2 second = twoProduct(-q.asDouble, halfPiParts[1]);
  Double2 sum = twoSum(first, second.hi);
  return {q.asInt, {sum.hi, fma(-q.asDouble, halfPiParts[2], sum.lo + second.lo)}};
}

/// For finite x >= 2^-22: only those bits of 2/pi are multiplied that matter modulo 4 (Payne and
/// Hanek, "Radian reduction for trigonometric functions", SIGNUM Newsletter 18(1), 1983).
///
/// x = m 2^e with a 24-bit integer m. The bits of 2/pi with weights 2^(1-e), 2^-e, ... 2^(-126-e),
/// read as a 128-bit integer w, give m w 2^-126 = x 2/pi modulo 4, less than 2^-102 too small.
inline QuadrantReduction reduceHuge(float x) {
  uint32_t bits = bitsOf(x);
  uint64_t m = (bits & 0x007fffffu) | 0x00800000u;
  int e = int(bits >> 23) - 150;

  int start = 64 + e - 2; // the table begins with 64 zero bits
  const uint64_t *words = twoOverPiBits + (start >> 6);
  int shift = start & 63;
  uint64_t high = (words[0] << shift) | ((words[1] >> 1) >> (63 - shift));
  uint64_t low = (words[1] << shift) | ((words[2] >> 1) >> (63 - shift));

  __extension__ using Wide = unsigned __int128;
  Wide turns = (Wide(high * m) << 64) + Wide(low) * m;

  // Nearest quadrant; the rest becomes a sign and a magnitude of at most 2^125.
  int quadrant = int((turns + (Wide(1) << 125)) >> 126) & 3;
  Wide rest = turns - (Wide(unsigned(quadrant)) << 126);
  bool negative = (rest >> 127) != 0;
  Wide magnitude = negative ? Wide(0) - rest : rest;

  // Upper and lower bits as doubles: the upper 53 at most, exactly, and the lower ones rounded.
  uint64_t upper = uint64_t(magnitude >> 75);
  uint64_t lower = uint64_t(magnitude >> 11);
  Double2 fraction =
      fastTwoSum(double(upper) * powerOfTwo(75 - 126), double(lower) * powerOfTwo(11 - 126));
  Double2 r = multiply(fraction, halfPi);
  return {quadrant, negative ? negate(r) : r};
}

/// For finite x >= 0.
inline QuadrantReduction reduceToQuadrant(float x) {
  return x < 0x1p19f ? reduceModerate(x) : reduceHuge(x);
}

} // namespace rtsl::device::detail
