//===- Sampler.h - the random numbers of the rays of a sample -------------===//
//
// What `rand()` draws, where in its pixel a sample lies, and what else is random about it, for the
// samplers that a program may be compiled with:
//
//   independent   Random.h: the numbers of different samples are independent; only the positions in
//                 the pixel and the times in the shutter are spread evenly
//   r2, sobol     the numbers of a pixel's samples are spread evenly, too
//
// An evenly spread sequence has a point for each sample of a pixel. Pairs of draws (0 and 1, 2 and
// 3, ...) are its coordinates. Each pair has an order of the points and a randomisation of its own,
// drawn by a hash of the pixel, the seed, the ray's place in the tree of rays, and the pair:
// different pairs are independent, but each is spread evenly over the samples (padding: Kollig and
// Keller, "Efficient Multidimensional Sampling", 2002). The order is a nested uniform
// permutation of the sample numbers, which maps the first 2^n of them to 2^n successive points, up
// to their order (Burley, "Practical Hash-based Owen Scrambling", Journal of Computer Graphics
// Techniques 9(4), 2020).
//
// A ray's key is then the sample's number and the hash of its place. A program's sampler is a
// constant of it: one with independent numbers contains none of this.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/ray/Abi.h"
#include "runtime/device/ray/Random.h"

namespace rtsl::device {

/// The sampler of the program of `state`; 0: independent numbers.
inline uint32_t evenSampler(const RtslState &state) {
  return rtsl_features(const_cast<RtslState *>(&state)) & RTSL_FEATURE_SAMPLERS;
}

/// A permutation of words in which a bit depends on the bits below it: applied to a word with its
/// bits reversed, Owen's nested uniform scrambling (Laine and Karras, "Stratified Sampling for
/// Stochastic Transparency", 2011; this hash: Vegdahl, "Building a Better LK Hash", 2021).
inline uint32_t permuteUpwards(uint32_t x, uint32_t seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}

/// Coordinate 0 or 1 of the Sobol sequence, of the point whose number is `reversed` with its bits
/// reversed, as a fraction of 2^32. Coordinate 0 is van der Corput's; the matrix of coordinate 1 is
/// Pascal's triangle modulo 2, here as the product of five sparse ones.
inline uint32_t sobolCoordinate(uint32_t reversed, uint32_t coordinate) {
  if (coordinate == 0)
    return reversed;
  reversed ^= (reversed & 0x0000ffffu) << 16;
  reversed ^= (reversed & 0x00ff00ffu) << 8;
  reversed ^= (reversed & 0x0f0f0f0fu) << 4;
  reversed ^= (reversed & 0x33333333u) << 2;
  reversed ^= (reversed & 0x55555555u) << 1;
  return reversed;
}

/// Coordinate 0 or 1 of pair `pair` of sample `sample`, as a fraction of 2^32.
inline uint32_t evenFraction(uint32_t sampler, uint32_t sample, uint32_t place, uint32_t pair,
                             uint32_t coordinate) {
  const Words3 hash = hash3(place, pair, 0x65766e73u);
  const uint32_t reversed = permuteUpwards(reverseBits(sample), hash.x);
  const uint32_t randomness = coordinate == 0 ? hash.y : hash.z;
  if (sampler & RTSL_FEATURE_SAMPLER_SOBOL)
    return reverseBits(
        permuteUpwards(reverseBits(sobolCoordinate(reversed, coordinate)), randomness));
  return randomness + reverseBits(reversed) * (coordinate == 0 ? 3242174889u : 2447445414u);
}

/// Draw number `dimension` of the ray: uniform in [0, 1), with 24 significant bits even near 0, as
/// randomNumber().
inline float drawNumber(const RtslState &state, uint32_t dimension) {
  const uint32_t sampler = evenSampler(state);
  if (!sampler)
    return randomNumber(state.randomKey, dimension);
  const uint32_t first =
      evenFraction(sampler, state.randomKey[0], state.randomKey[1], dimension / 2, dimension % 2);
  return numberOfWord(state.randomKey, dimension, first);
}

/// The same, in (0, 1).
inline float drawOpenNumber(const RtslState &state, uint32_t dimension) {
  const float drawn = drawNumber(state, dimension);
  return drawn == 0 ? 0x1p-149f : drawn;
}

/// Sets the key of a ray that `parent` sends when its counter is `dimension`. They may be the same.
inline void setChildKey(RtslState &child, const RtslState &parent, uint32_t dimension) {
  if (!evenSampler(parent))
    return childKey(parent.randomKey, dimension, child.randomKey);
  child.randomKey[0] = parent.randomKey[0];
  child.randomKey[1] = hash3(parent.randomKey[1], dimension, 0x6368696cu).x;
}

/// The key of the shadow rays of a point, which no other ray has.
inline void setShadowKey(uint32_t key[2], const RtslState &shading) {
  if (evenSampler(shading)) {
    key[0] = shading.randomKey[0];
    key[1] = hash3(shading.randomKey[1], shading.dimension, 0x73686164u).x;
    return;
  }
  key[0] = shading.randomKey[0] ^ 0x9e3779b9u;
  key[1] = shading.randomKey[1] + shading.dimension * 0x9e3779b9u;
}

/// What is random about a sample, apart from the draws of its rays: each uniform in [0, 1).
struct SampleNumbers {
  float pixel[2], lens[2], timeSeed;
  float shutter; // 0: when it opens, 1: when it closes
};

/// Begins sample `number` of a pixel: sets the key of its first ray. Those from RTSL_SECOND_HALF on
/// are a sequence of their own.
inline SampleNumbers beginRandomNumbers(RtslState &state, uint32_t x, uint32_t y, uint32_t number,
                                        uint32_t seed) {
  state.dimension = 0;
  const uint32_t index = number & (RTSL_SECOND_HALF - 1);
  seed ^= number / RTSL_SECOND_HALF * 0x9e3779b9u;
  const Words4 ofPixel = hash4(x, y, 0xffffffffu, seed); // the same for all samples of the pixel
  if (const uint32_t sampler = evenSampler(state)) {
    state.randomKey[0] = index;
    state.randomKey[1] = ofPixel.z;
    const auto drawn = [&](uint32_t pair, uint32_t coordinate) {
      return unitFloat(evenFraction(sampler, index, ofPixel.w, pair, coordinate));
    };
    return {{drawn(0, 0), drawn(0, 1)}, {drawn(1, 0), drawn(1, 1)}, drawn(2, 0), drawn(2, 1)};
  }
  const Words4 key = hash4(x, y, index, seed);
  state.randomKey[0] = key.x;
  state.randomKey[1] = key.y;
  SampleNumbers numbers;
  pixelSample(index, ofPixel.x, ofPixel.y, &numbers.pixel[0], &numbers.pixel[1]);
  numbers.lens[0] = unitFloat(key.z);
  numbers.lens[1] = unitFloat(key.w);
  numbers.timeSeed = unitFloat(key.x * 0x9e3779b9u ^ key.y);
  numbers.shutter = unitFloat(reverseBits(index) ^ hash4(x, y, 0xfffffffeu, seed).x);
  return numbers;
}

} // namespace rtsl::device
