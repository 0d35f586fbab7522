// Machine-level basics of all functions in this folder: bit patterns, the fused multiply-add and
// the square root.
//
// All arithmetic here is IEEE double in round-to-nearest, to be compiled with -ffp-contract=off. No
// result depends on that (a build with =fast passed the same exhaustive test), but the error
// analysis assumes arithmetic that is compiled as written.
#pragma once

#include <stdint.h> // not <cstdint>: the device has no C++ library

namespace rtsl::device::detail {

inline uint32_t bitsOf(float x) {
  return __builtin_bit_cast(uint32_t, x);
}
inline uint64_t bitsOf(double x) {
  return __builtin_bit_cast(uint64_t, x);
}
inline float floatOf(uint32_t bits) {
  return __builtin_bit_cast(float, bits);
}
inline double doubleOf(uint64_t bits) {
  return __builtin_bit_cast(double, bits);
}

// Clang's plain __builtin_fma and __builtin_sqrt may become calls into a libm that a device does
// not have.
#if defined(__clang__)
inline double fma(double a, double b, double c) {
  return __builtin_elementwise_fma(a, b, c);
}
inline double squareRoot(double x) {
  return __builtin_elementwise_sqrt(x);
}
inline float squareRoot(float x) {
  return __builtin_elementwise_sqrt(x);
}
#else
inline double fma(double a, double b, double c) {
  return __builtin_fma(a, b, c);
}
inline double squareRoot(double x) {
  return __builtin_sqrt(x);
}
inline float squareRoot(float x) {
  return __builtin_sqrtf(x);
}
#endif

inline constexpr uint32_t floatSignBit = 0x80000000u;
inline constexpr uint32_t floatInfinityBits = 0x7f800000u;

inline float infinity() {
  return floatOf(floatInfinityBits);
}

/// The one NaN that these functions return: quiet, positive, without payload.
inline float canonicalNaN() {
  return floatOf(0x7fc00000u);
}

/// Whether x is positive, normal and finite.
inline bool isPositiveNormal(float x) {
  constexpr uint32_t least = 0x00800000u;
  return bitsOf(x) - least < floatInfinityBits - least;
}

inline bool isNaN(float x) {
  return x != x;
}
inline float absolute(float x) {
  return floatOf(bitsOf(x) & ~floatSignBit);
}
inline double absolute(double x) {
  return doubleOf(bitsOf(x) & ~(uint64_t(1) << 63));
}

/// `magnitude` (not negative) with the sign of `sign`, signed zeros included.
inline float withSignOf(float magnitude, float sign) {
  return floatOf(bitsOf(magnitude) | (bitsOf(sign) & floatSignBit));
}

/// 2^exponent for exponents of normal doubles, -1022..1023.
inline double powerOfTwo(int exponent) {
  return doubleOf(uint64_t(exponent + 1023) << 52);
}

/// Adding it leaves no bits after the binary point and puts the integer into the low bits of the
/// sum.
inline constexpr double integerShifter = 0x1.8p52;

/// The integer nearest to x (ties to even), for |x| < 2^31, both as a double and as an int.
struct NearestInteger {
  double asDouble;
  int asInt;
};
inline NearestInteger nearestInteger(double x) {
  double shifted = x + integerShifter;
  return {shifted - integerShifter, int(uint32_t(bitsOf(shifted)))};
}

} // namespace rtsl::device::detail
