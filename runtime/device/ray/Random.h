//===- Random.h - counter-based random numbers ----------------------------===//
//
// A random number is a hash of its position: (pixel, sample, seed) form the key of the camera ray,
// a spawned ray has the hash of its parent's key and dimension, and a ray counts its draws in
// `dimension`. So numbers do not depend on threads or on the order of rays. The hashes are
// PCG3D and PCG4D of Jarzynski and Olano, "Hash Functions for GPU Rendering", Journal of Computer
// Graphics Techniques 9(3), 2020.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <stdint.h>

namespace rtsl::device {

struct Words3 {
  uint32_t x, y, z;
};

inline Words3 hash3(uint32_t x, uint32_t y, uint32_t z) {
  x = x * 1664525u + 1013904223u;
  y = y * 1664525u + 1013904223u;
  z = z * 1664525u + 1013904223u;
  x += y * z;
  y += z * x;
  z += x * y;
  x ^= x >> 16;
  y ^= y >> 16;
  z ^= z >> 16;
  x += y * z;
  y += z * x;
  z += x * y;
  return {x, y, z};
}

struct Words4 {
  uint32_t x, y, z, w;
};

inline Words4 hash4(uint32_t x, uint32_t y, uint32_t z, uint32_t w) {
  x = x * 1664525u + 1013904223u;
  y = y * 1664525u + 1013904223u;
  z = z * 1664525u + 1013904223u;
  w = w * 1664525u + 1013904223u;
  x += y * w;
  y += z * x;
  z += x * y;
  w += y * z;
  x ^= x >> 16;
  y ^= y >> 16;
  z ^= z >> 16;
  w ^= w >> 16;
  x += y * w;
  y += z * x;
  z += x * y;
  w += y * z;
  return {x, y, z, w};
}

/// Uniform in [0, 1): the upper 24 bits, so that every value is exact and cannot be rounded to 1.
/// For positions, which need no extra digits near 0.
inline float unitFloat(uint32_t bits) {
  return float(bits >> 8) * 0x1p-24f;
}

/// The largest float that is not above the binary fraction 0.words[0] words[1] ... of 149 bits.
/// Each float in [0, 1) is as likely as a real number between it and the next float.
inline float floatOfFraction(const uint32_t words[5]) {
  uint32_t first = 0;
  while (first < 3 && words[first] == 0)
    ++first;
  uint32_t next = words[first + 1];
  if (first == 3)
    next &= ~0x7ffu; // bits below the smallest float
  const uint64_t window = (uint64_t(words[first]) << 32) | next;
  if (window == 0)
    return 0;
  const int zeros = __builtin_clzll(window);
  const auto leading = uint32_t((window << zeros) >> 40); // 24 bits
  // In double, where 2^-183 is normal; the product is a float.
  const uint64_t scaleBits = uint64_t(1023 - 24 - zeros - 32 * int(first)) << 52;
  double scale;
  __builtin_memcpy(&scale, &scaleBits, sizeof scale);
  return float(double(leading) * scale);
}

/// numberOfWord() if the first word does not have 24 significant bits, as happens once in 512
/// draws.
__attribute__((cold, const, noinline)) inline float
smallRandomNumber(uint32_t keyX, uint32_t keyY, uint32_t dimension, uint32_t first) {
  const Words4 more = hash4(keyX, keyY, dimension, 0x5bd1e995u);
  const uint32_t words[5] = {first, more.x, more.y, more.z, more.w};
  return floatOfFraction(words);
}

/// The largest float that is not above x, which is at least 2^23.
inline float roundedDown(uint32_t x) {
#ifdef __NVPTX__
  return __nvvm_ui2f_rz(x);
#else
  return float(x & ~(0xffu >> __builtin_clz(x)));
#endif
}

/// The number in [0, 1) whose first 32 binary digits are `first` and whose others are hashed, with
/// 24 significant bits even near 0. (With the leading bits of one word only, as in unitFloat(),
/// there is nothing between 0 and 2^-24; see Downey, "Generating Pseudo-random Floating-Point
/// Values", 2007.)
inline float numberOfWord(const uint32_t key[2], uint32_t dimension, uint32_t first) {
  if (first < 1u << 23)
    return smallRandomNumber(key[0], key[1], dimension, first);
  return roundedDown(first) * 0x1p-32f; // exact, so that it is not rounded to 1
}

/// Draw number `dimension` of the ray with this key: uniform in [0, 1).
inline float randomNumber(const uint32_t key[2], uint32_t dimension) {
  return numberOfWord(key, dimension, hash3(key[0], key[1], dimension).x);
}

/// The same draw, with 0 replaced by the smallest float: uniform in (0, 1).
inline float openRandomNumber(const uint32_t key[2], uint32_t dimension) {
  const float drawn = randomNumber(key, dimension);
  return drawn == 0 ? 0x1p-149f : drawn;
}

/// The key of a ray that is spawned when its parent's counter is `dimension`. It uses the words of
/// the hash that randomNumber does not.
inline void childKey(const uint32_t parent[2], uint32_t dimension, uint32_t child[2]) {
  Words3 hash = hash3(parent[0], parent[1], dimension);
  child[0] = hash.y;
  child[1] = hash.z;
}

/// Point `index` of the R2 sequence, as fractions of 2^32, shifted by an offset per pixel: an
/// additive recurrence with powers of the plastic number, which fills the unit square evenly for
/// any number of samples (Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences", 2018;
/// the shift: Cranley and Patterson 1976).
inline void pixelSample(uint32_t index, uint32_t shiftX, uint32_t shiftY, float *x, float *y) {
  *x = unitFloat(shiftX + index * 3242174889u); // 2^32 / 1.32471795724
  *y = unitFloat(shiftY + index * 2447445414u); // 2^32 / 1.32471795724^2
}

/// Element x of van der Corput's sequence (1935), as a fraction of 2^32: any 2^n consecutive
/// elements that begin at a multiple of 2^n lie in different intervals of length 2^32 / 2^n. An
/// exclusive or with a constant preserves this.
inline uint32_t reverseBits(uint32_t x) {
#ifdef __clang__
  return __builtin_bitreverse32(x); // one instruction on a GPU
#else
  x = (x >> 1 & 0x55555555u) | (x & 0x55555555u) << 1;
  x = (x >> 2 & 0x33333333u) | (x & 0x33333333u) << 2;
  x = (x >> 4 & 0x0f0f0f0fu) | (x & 0x0f0f0f0fu) << 4;
  return __builtin_bswap32(x);
#endif
}

} // namespace rtsl::device
