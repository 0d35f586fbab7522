//===- Random.h - counter-based random numbers ----------------------------===//
//
// A random number is a hash of where it is drawn: (pixel, sample, seed) make the key of the camera
// ray, a ray that is spawned has the hash of its parent's key and dimension, and a ray counts its
// draws in `dimension`. So numbers do not depend on threads or on the order of rays. The hashes are
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

/// Uniform in [0, 1): the upper 24 bits, so that every value is exact and 1 cannot come out by
/// rounding.
inline float unitFloat(uint32_t bits) {
  return float(bits >> 8) * 0x1p-24f;
}

/// The draw number `dimension` of the ray with this key.
inline float randomNumber(const uint32_t key[2], uint32_t dimension) {
  return unitFloat(hash3(key[0], key[1], dimension).x);
}

/// The key of a ray that is spawned when its parent's counter stands at `dimension`. It takes the
/// words of the hash that randomNumber leaves.
inline void childKey(const uint32_t parent[2], uint32_t dimension, uint32_t child[2]) {
  Words3 hash = hash3(parent[0], parent[1], dimension);
  child[0] = hash.y;
  child[1] = hash.z;
}

/// Point `index` of the R2 sequence, as fractions of 2^32, moved by a shift of the pixel's own: an
/// additive recurrence with the plastic number's powers, which fills the unit square evenly for any
/// number of samples (Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences", 2018; the
/// shift: Cranley and Patterson 1976).
inline void pixelSample(uint32_t index, uint32_t shiftX, uint32_t shiftY, float *x, float *y) {
  *x = unitFloat(shiftX + index * 3242174889u); // 2^32 / 1.32471795724
  *y = unitFloat(shiftY + index * 2447445414u); // 2^32 / 1.32471795724^2
}

} // namespace rtsl::device
