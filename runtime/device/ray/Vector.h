//===- Vector.h - three floats --------------------------------------------===//
//
// Only what traversal and the engines need. Nothing here is contracted: fused operations are
// explicit.
//
//===----------------------------------------------------------------------===//
#pragma once

namespace rtsl::device {

struct Vec3 {
  float x, y, z;

  float operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }
};

inline Vec3 load(const float *p) {
  return {p[0], p[1], p[2]};
}
inline void store(float *p, Vec3 v) {
  p[0] = v.x;
  p[1] = v.y;
  p[2] = v.z;
}

/// The same vector. For the compiler of a GPU it depends on `on`: so what is computed of it in a
/// branch within a loop stays there. In front of the loop it would be computed once, but wait in
/// registers until the loop ends.
inline Vec3 dependingOn([[maybe_unused]] float on, Vec3 v) {
#ifdef __NVPTX__
  asm("" : "+f"(v.x), "+f"(v.y), "+f"(v.z) : "f"(on));
#endif
  return v;
}

inline Vec3 operator+(Vec3 a, Vec3 b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vec3 operator-(Vec3 a, Vec3 b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vec3 operator*(Vec3 a, float s) {
  return {a.x * s, a.y * s, a.z * s};
}

inline float absolute(float a) {
  return __builtin_fabsf(a);
}
inline float squareRoot(float a) {
  return __builtin_sqrtf(a);
}
inline float fused(float a, float b, float c) {
  return __builtin_fmaf(a, b, c);
}
/// If either is NaN: b.
inline float maximum(float a, float b) {
  return a > b ? a : b;
}
inline float minimum(float a, float b) {
  return a < b ? a : b;
}

/// The larger of two numbers, or `limit` if the other one is NaN. If both are 0, the sign depends
/// on the processor; no distance of a hit is 0.
inline float raised(float limit, float x) {
#ifdef __NVPTX__
  return __builtin_fmaxf(limit, x); // one instruction
#else
  return x > limit ? x : limit;
#endif
}
/// The smaller one, likewise.
inline float lowered(float limit, float x) {
#ifdef __NVPTX__
  return __builtin_fminf(limit, x);
#else
  return x < limit ? x : limit;
#endif
}

inline float dot(Vec3 a, Vec3 b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline float largest(Vec3 a) {
  return maximum(maximum(absolute(a.x), absolute(a.y)), absolute(a.z));
}
inline bool isZero(Vec3 a) {
  return a.x == 0 && a.y == 0 && a.z == 0;
}

/// a b - c d, off by at most 1.5 units in the last place, so that its sign is right and it is zero
/// only when it should be (Kahan; proof: Jeannerod, Louvet, Muller, "Further analysis of Kahan's
/// algorithm for the accurate computation of 2x2 determinants", 2013), unless a product underflows.
inline float differenceOfProducts(float a, float b, float c, float d) {
  float cd = c * d;
  float error = fused(-c, d, cd);
  return fused(a, b, -cd) + error;
}

inline Vec3 cross(Vec3 a, Vec3 b) {
  return {differenceOfProducts(a.y, b.z, a.z, b.y), differenceOfProducts(a.z, b.x, a.x, b.z),
          differenceOfProducts(a.x, b.y, a.y, b.x)};
}

inline unsigned bitsOf(float number) {
  unsigned bits;
  __builtin_memcpy(&bits, &number, sizeof bits);
  return bits;
}
inline float floatOf(unsigned bits) {
  float number;
  __builtin_memcpy(&number, &bits, sizeof number);
  return number;
}

constexpr float infinity = __builtin_inff(), largestFloat = 0x1.fffffep+127f;
/// Half a unit in the last place of 1: the largest relative error of one rounding.
constexpr float roundingUnit = 0x1p-24f;

/// Is it 0 or above, and neither infinite nor NaN? Compared with the largest float: a comparison
/// with infinity becomes a test of the class of a float, which takes a CPU a dozen instructions.
inline bool isFiniteFromZero(float x) {
  return x >= 0 && x <= largestFloat;
}

/// False for infinities and NaN.
inline bool isFinite(Vec3 a) {
#ifdef __NVPTX__
  return fused(a.x, 0.0f, fused(a.y, 0.0f, a.z * 0.0f)) == 0.0f; // one instruction each
#else
  return (a.x * 0.0f + a.y * 0.0f) + a.z * 0.0f == 0.0f;
#endif
}

/// 2^exponent for -126 <= exponent <= 127.
inline float powerOfTwo(int exponent) {
  return floatOf(unsigned(exponent + 127) << 23);
}

/// e such that 2^e <= |a| < 2^(e+1), for normal numbers; -127 for smaller ones.
inline int exponentOf(float a) {
  return int((bitsOf(a) >> 23) & 255) - 127;
}

/// A vector of length 1, for any length of `a` (except 0, which stays 0).
inline Vec3 normalized(Vec3 a) {
  float size = largest(a);
  if (!(size > 0x1p-40f && size < 0x1p40f)) {
    if (!(size > 0 && size < infinity))
      return a;
    int exponent = exponentOf(size);
    // In two steps, because 2^-exponent alone may not be representable.
    a = a * powerOfTwo(exponent < -100 ? 100 : exponent > 100 ? -100 : -exponent);
    size = largest(a);
    a = a * powerOfTwo(-exponentOf(size));
  }
  return a * (1.0f / squareRoot(dot(a, a)));
}

} // namespace rtsl::device
