//===- Sums.h - sums of all elements before each --------------------------===//
//
// In one step, by warps with a tile of elements each: a warp adds up its own, and then those of the
// tiles before, as far as these have told their sums (Merrill and Garland, "Single-pass Parallel
// Prefix Scan with Decoupled Look-back", 2016). Warps take tiles in order, so a tile that another
// one waits for has always begun. Sums of integers do not depend on who told what when.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/trees/TreeBuild.h"

namespace rtsl::device::build {

/// A sum is two numbers below 2^31, one in each half. Told in 62 bits, below these.
constexpr uint64_t toldOfTile = uint64_t(1) << 62, toldUpToTile = uint64_t(2) << 62;

inline uint64_t told(uint64_t sum, uint64_t what) {
  return (sum & 0x7fffffff) | (sum >> 32) << 31 | what;
}
inline uint64_t sumTold(uint64_t word) {
  return (word & 0x7fffffff) | (word >> 31 & 0x7fffffff) << 32;
}

/// Tells the sum of a tile, and gives that of all tiles before.
inline uint64_t sumOfTilesBefore(uint64_t *words, uint32_t tile, uint64_t own, uint32_t lane) {
  const auto tell = [&](uint64_t word) {
    if (lane == 0)
      __atomic_store_n(words + tile, word, __ATOMIC_RELAXED);
  };
  uint64_t sum = 0;
  if (tile != 0)
    tell(told(own, toldOfTile));
  for (uint32_t end = tile; end != 0; end = end < lanes ? 0 : end - lanes) {
    uint64_t word = toldUpToTile; // before the first tile there is nothing
    do {
      if (lane < end)
        word = __atomic_load_n(words + (end - 1 - lane), __ATOMIC_RELAXED);
    } while (warp::lanesWhere(word < toldOfTile));
    const uint32_t whole = warp::lanesWhere(word >= toldUpToTile);
    const bool counts = !whole || lane <= uint32_t(__builtin_ctz(whole));
    sumBefore(counts ? sumTold(word) : 0, lane, sum);
    if (whole)
      break;
  }
  tell(told(sum + own, toldUpToTile));
  return sum;
}

/// Takes a tile of the elements, and calls use(i, sum) for each of its own: with
/// `sum` = value(0) + ... + value(i - 1). The calls of a build have the numbers 0 and 1 in turn.
/// Both should be short: a lane has several elements, one after the other.
template <typename Value, typename Use>
void forSumsBefore(const TreeBuild &build, uint32_t thread, uint32_t elements, uint32_t number,
                   Value value, Use use) {
  const uint32_t lane = thread % lanes, ofTile = elementsOfTile(elements);
  const auto tiles = uint32_t((uint64_t(elements) + ofTile - 1) / ofTile);
  SumCall &call = build.calls[number], &last = build.calls[number ^ 1];
  uint32_t tile = 0;
  if (lane == 0)
    tile = __atomic_fetch_add(&call.begun, 1u, __ATOMIC_RELAXED);
  tile = uint32_t(valueOfLane(tile, 0));
  if (tile >= tiles)
    return;
  const auto forEachOfTile = [&](auto row) { forEachRow(tile, ofTile, lane, elements, row); };
  uint64_t own = 0, ofLane = 0;
  forEachOfTile([&](uint32_t i, bool isElement) { ofLane += isElement ? value(i) : 0; });
  sumBefore(ofLane, lane, own);
  uint64_t sum = sumOfTilesBefore(build.wordsOf(number), tile, own, lane);
  if (lane == 0 && tile + 1 == tiles) {
    call.tiles = tiles;
    call.sum = sum + own;
  }
  forEachOfTile([&](uint32_t i, bool isElement) {
    const uint64_t before = sum, one = isElement ? value(i) : 0;
    const uint64_t here = before + sumBefore(one, lane, sum);
    if (isElement)
      use(i, here);
  });
  // For the next call:
  for (uint64_t other = uint64_t(tile) * lanes + lane; other < last.tiles;
       other += uint64_t(tiles) * lanes)
    build.wordsOf(number ^ 1)[other] = 0;
  if (tile == 0 && lane == 0)
    last.begun = 0;
}

/// Replaces each of the numbers by the sum of those before it.
inline void sumNumbers(const TreeBuild &build, uint32_t thread, uint32_t elements, uint32_t call) {
  forSumsBefore(
      build, thread, elements, call, [&](uint32_t i) { return build.numbers[i]; },
      [&](uint32_t i, uint64_t sum) { build.numbers[i] = sum; });
}

/// Before the first call.
inline void beginSums(const TreeBuild &build, uint32_t i) {
  build.words[0][i] = build.words[1][i] = 0;
  if (i < 2)
    build.calls[i] = {0, 0, 0};
}

} // namespace rtsl::device::build
