//===- HalfPair.h - two numbers of half precision -------------------------===//
//
// A GPU of sm_80 or later has instructions for two at once. LLVM divides operations on vectors of
// halves, so the instructions are given here.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <stdint.h>

namespace rtsl::device {

#ifdef __NVPTX__

/// The first number is in the lower half.
struct HalfPair {
  uint32_t bits;
};

inline HalfPair pairOf(uint32_t bits) {
  return {bits};
}
inline uint32_t bitsOf(HalfPair a) {
  return a.bits;
}
/// The same number twice, rounded to nearest.
inline HalfPair both(float number) {
  HalfPair pair;
  asm("cvt.rn.f16x2.f32 %0, %1, %1;" : "=r"(pair.bits) : "f"(number));
  return pair;
}
inline HalfPair operator-(HalfPair a) {
  HalfPair result;
  asm("neg.f16x2 %0, %1;" : "=r"(result.bits) : "r"(a.bits));
  return result;
}
inline HalfPair operator+(HalfPair a, HalfPair b) {
  HalfPair result;
  asm("add.rn.f16x2 %0, %1, %2;" : "=r"(result.bits) : "r"(a.bits), "r"(b.bits));
  return result;
}
/// a b + c, rounded once.
inline HalfPair fused(HalfPair a, HalfPair b, HalfPair c) {
  HalfPair result;
  asm("fma.rn.f16x2 %0, %1, %2, %3;" : "=r"(result.bits) : "r"(a.bits), "r"(b.bits), "r"(c.bits));
  return result;
}
/// If one of two is NaN, the other one.
inline HalfPair larger(HalfPair a, HalfPair b) {
  HalfPair result;
  asm("max.f16x2 %0, %1, %2;" : "=r"(result.bits) : "r"(a.bits), "r"(b.bits));
  return result;
}
inline HalfPair smaller(HalfPair a, HalfPair b) {
  HalfPair result;
  asm("min.f16x2 %0, %1, %2;" : "=r"(result.bits) : "r"(a.bits), "r"(b.bits));
  return result;
}

#elif defined(__clang__) // for tests; GCC 12 has no such type in C++

using HalfPair = _Float16 __attribute__((ext_vector_type(2)));

inline HalfPair pairOf(uint32_t bits) {
  return __builtin_bit_cast(HalfPair, bits);
}
inline uint32_t bitsOf(HalfPair a) {
  return __builtin_bit_cast(uint32_t, a);
}
inline HalfPair both(float number) {
  const auto half = _Float16(number);
  return {half, half};
}
inline HalfPair fused(HalfPair a, HalfPair b, HalfPair c) {
  return __builtin_elementwise_fma(a, b, c);
}
inline HalfPair larger(HalfPair a, HalfPair b) {
  return __builtin_elementwise_max(a, b);
}
inline HalfPair smaller(HalfPair a, HalfPair b) {
  return __builtin_elementwise_min(a, b);
}

#endif

} // namespace rtsl::device
