//===- Divisor.h - division by a number that is used often ----------------===//
//
// GPUs have no instructions that divide.
//
// Integers: for each divisor d from 1 to 2^32 - 1 there are numbers m, a and s such that floor(n/d)
// = floor((n m + a) / 2^(32 + s)) for every n of 32 bits; a is 0 or m (Robison, "N-Bit Unsigned
// Division via N-Bit Multiply-Add", 2005).
//
// Floats: with the inverse of b, rounded to nearest, q + (a - q b) inverse is the correctly rounded
// a / b if q is off by less than a unit in the last place (Markstein, "Computation of Elementary
// Functions on the IBM RISC System/6000 Processor", 1990). The product of a and the inverse may be
// off by more; the same step improves it first.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/ray/Launch.h"
#include "runtime/device/ray/Vector.h"

namespace rtsl::device {

/// Of a divisor that is not 0.
inline RtslDivisor makeDivisor(uint32_t divisor) {
  const auto shift = uint32_t(31 - __builtin_clz(divisor));
  if ((divisor & (divisor - 1)) == 0)
    return {0xffffffffu, 0xffffffffu, shift}; // (n + 1) (2^32 - 1) / 2^32 is n
  const uint64_t power = uint64_t(1) << (32 + shift);
  const auto below = uint32_t(power / divisor);
  const uint32_t excess = (below + 1) * divisor; // of (below + 1) * divisor over 2^(32 + shift)
  if (excess <= uint32_t(1) << shift)
    return {below + 1, 0, shift};
  return {below, below, shift};
}

inline uint32_t quotient(uint32_t number, const RtslDivisor &by) {
  return uint32_t((uint64_t(number) * by.multiplier + by.increment) >> 32) >> by.shift;
}

/// a / b, correctly rounded, for a that is 0 or from 2^-24 to 2^33, and b from 1 to 2^32.
inline float quotientByInverse(float a, float b, float inverse) {
  const float first = a * inverse;
  const float better = fused(fused(-first, b, a), inverse, first);
  return fused(fused(-better, b, a), inverse, better);
}

/// The same, as is fastest.
inline float quotient(float a, float b, [[maybe_unused]] float inverse) {
#ifdef __NVPTX__
  return quotientByInverse(a, b, inverse);
#else
  return a / b;
#endif
}

/// Sets the size of a launch, all numbers from 1 on, and what divides by it.
inline void setLaunchSize(RtslLaunch &launch, uint32_t width, uint32_t height, uint32_t slices) {
  launch.width = width;
  launch.height = height;
  launch.slices = slices;
  launch.byHeight = makeDivisor(height);
  launch.inverseWidth = 1.0f / float(width);
  launch.inverseHeight = 1.0f / float(height);
}

} // namespace rtsl::device
