//===- Sort.h - items along a curve ---------------------------------------===//
//
// By the interleaved bits of their centres (Morton, 1966), with a radix sort. All functions are
// steps: what one thread does, of those for all elements or warps.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/trees/Sums.h"

namespace rtsl::device::build {

/// Half of the sum may be too large, the sum of the halves is not.
inline float centreOf(const RtslBox &box, int axis) {
  return 0.5f * box.lower[axis] + 0.5f * box.upper[axis];
}

inline void measureItem(const TreeBuild &build, uint32_t i) {
  build.boxes[build.count + i] = boxOfItem(build.items, i);
}

/// The range of the centres of items i, i + threads, ...
inline void rangeOfCentres(const TreeBuild &build, uint32_t i, uint32_t threads) {
  RtslBox range = emptyBox();
  for (uint64_t item = i; item < build.count; item += threads) {
    const RtslBox &box = build.boxes[build.count + item];
    RtslBox centre;
    for (int axis = 0; axis < 3; ++axis)
      centre.lower[axis] = centre.upper[axis] = centreOf(box, axis);
    extend(range, centre);
  }
  build.centres[i] = range;
}

/// Joins ranges i, i + threads, ..., of a larger number.
inline void joinRanges(const TreeBuild &build, uint32_t i, uint32_t threads, uint32_t number) {
  RtslBox range = build.centres[i];
  for (uint64_t other = uint64_t(i) + threads; other < number; other += threads)
    extend(range, build.centres[other]);
  build.centres[i] = range;
}

/// The lower 20 bits with two zeros before each.
inline uint64_t spread(uint64_t bits) {
  bits = (bits | bits << 32) & 0x001f00000000ffffull;
  bits = (bits | bits << 16) & 0x001f0000ff0000ffull;
  bits = (bits | bits << 8) & 0x100f00f00f00f00full;
  bits = (bits | bits << 4) & 0x10c30c30c30c30c3ull;
  return (bits | bits << 2) & 0x1249249249249249ull;
}

inline void makeKey(const TreeBuild &build, uint32_t i) {
  const RtslBox &box = build.boxes[build.count + i], &all = build.centres[0];
  // One scale for all axes, so that the curve divides space into cubes.
  double size = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double one = double(all.upper[axis]) - double(all.lower[axis]);
    size = one > size ? one : size;
  }
  constexpr double cells = double(1u << bitsOfAxis);
  uint64_t key = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double place = double(centreOf(box, axis)) - double(all.lower[axis]);
    const double cell = size > 0 ? place / size * cells : 0;
    key |= spread(cell < cells ? uint64_t(cell) : (1u << bitsOfAxis) - 1) << axis;
  }
  build.keys[0][i] = key;
  build.order[0][i] = i;
}

inline uint32_t digitOf(uint64_t key, uint32_t pass) {
  return uint32_t(key >> (pass * digitBits)) & (digits - 1);
}

/// The numbers are those of digit 0 for all tiles, of digit 1, ...
inline void countDigits(const TreeBuild &build, uint32_t thread, uint32_t pass) {
  const uint32_t tile = thread / lanes, lane = thread % lanes;
  PerDigit numbers;
  forEachRow(tile, tileSize, lane, build.count, [&](uint32_t i, bool isElement) {
    const uint64_t key = isElement ? build.keysOf(pass & 1)[i] : 0;
    numbers.count(digitOf(key, pass), isElement, lane);
  });
  numbers.store(build.numbers + tile, tileCount(build.count), lane);
}

inline void moveByDigit(const TreeBuild &build, uint32_t thread, uint32_t pass) {
  const uint32_t tile = thread / lanes, lane = thread % lanes, from = pass & 1, to = from ^ 1;
  PerDigit numbers;
  numbers.load(build.numbers + tile, tileCount(build.count), lane);
  forEachRow(tile, tileSize, lane, build.count, [&](uint32_t i, bool isElement) {
    const uint64_t key = isElement ? build.keysOf(from)[i] : 0;
    const uint64_t place = numbers.count(digitOf(key, pass), isElement, lane);
    if (!isElement)
      return;
    build.keysOf(to)[place] = key;
    build.orderOf(to)[place] = build.orderOf(from)[i];
  });
}

} // namespace rtsl::device::build
