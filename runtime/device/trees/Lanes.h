//===- Lanes.h - lanes that build together --------------------------------===//
//
// Steps of a build that sum or sort run on whole warps, each of which has a tile of elements, row
// by row, one lane for each element of a row. On a CPU a warp has one lane.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/ray/Warp.h"

#include <stdint.h>

namespace rtsl::device::build {

constexpr uint32_t tileSize = 1024; // elements for a warp that sorts
constexpr uint32_t digitBits = 5, digits = 1u << digitBits;

#ifdef __NVPTX__

constexpr uint32_t lanes = 32;

inline uint64_t valueOfLane(uint64_t value, uint32_t lane) {
  const auto low = uint32_t(warp::valueOf(int32_t(value), int(lane))),
             high = uint32_t(warp::valueOf(int32_t(value >> 32), int(lane)));
  return uint64_t(high) << 32 | low;
}

/// The sum of this number on the lanes before this one; adds that of all to `sum`.
inline uint64_t sumBefore(uint64_t value, uint32_t lane, uint64_t &sum) {
  uint64_t upToHere = value;
  for (uint32_t distance = 1; distance < lanes; distance *= 2) {
    const uint64_t other = valueOfLane(upToHere, (lane - distance) & (lanes - 1));
    if (lane >= distance)
      upToHere += other;
  }
  sum += valueOfLane(upToHere, lanes - 1);
  return upToHere - value;
}

/// A number for each digit: lane n has that of digit n.
class PerDigit {
public:
  /// The numbers of a tile are `stride` apart.
  void load(const uint64_t *from, uint32_t stride, uint32_t lane) { number = from[lane * stride]; }
  void store(uint64_t *to, uint32_t stride, uint32_t lane) const { to[lane * stride] = number; }

  /// The lanes count their digits in the order of lanes. Gives what was counted before for this
  /// lane's digit. Lanes without an element take part.
  uint64_t count(uint32_t digit, bool isElement, uint32_t lane) {
    uint32_t ofDigit = warp::lanesWhere(isElement), ofThisLane = ofDigit;
    for (uint32_t bit = 0; bit < digitBits; ++bit) {
      const uint32_t where = warp::lanesWhere(digit >> bit & 1);
      ofDigit &= digit >> bit & 1 ? where : ~where;
      ofThisLane &= lane >> bit & 1 ? where : ~where;
    }
    const uint64_t before = valueOfLane(number, digit);
    number += uint32_t(__builtin_popcount(ofThisLane));
    return before + uint32_t(__builtin_popcount(ofDigit & ((1u << lane) - 1)));
  }

private:
  uint64_t number = 0;
};

#else

constexpr uint32_t lanes = 1;

inline uint64_t valueOfLane(uint64_t value, uint32_t) {
  return value;
}

inline uint64_t sumBefore(uint64_t value, uint32_t, uint64_t &sum) {
  sum += value;
  return 0;
}

class PerDigit {
public:
  void load(const uint64_t *from, uint32_t stride, uint32_t) {
    for (uint32_t digit = 0; digit < digits; ++digit)
      numbers[digit] = from[digit * stride];
  }
  void store(uint64_t *to, uint32_t stride, uint32_t) const {
    for (uint32_t digit = 0; digit < digits; ++digit)
      to[digit * stride] = numbers[digit];
  }
  uint64_t count(uint32_t digit, bool isElement, uint32_t) {
    return isElement ? numbers[digit]++ : 0;
  }

private:
  uint64_t numbers[digits] = {};
};

#endif

inline uint32_t tileCount(uint32_t elements) {
  return uint32_t((uint64_t(elements) + tileSize - 1) / tileSize);
}

/// Warps that sum elements have tiles of at least so many. On a GPU these are few rows, so that
/// there are many warps.
inline uint32_t leastInSum(uint32_t lanesOfWarp) {
  return lanesOfWarp == 1 ? 512 : 4 * lanesOfWarp;
}
/// More warps do not run at once.
constexpr uint32_t mostTilesOfSum = 8192;

/// The elements of a tile of a sum of so many.
inline uint32_t elementsOfTile(uint32_t elements) {
  const uint32_t rows = elements / (lanes * mostTilesOfSum) + 1, least = leastInSum(lanes);
  return lanes * rows < least ? least : lanes * rows;
}
/// The most tiles of sums of up to so many elements.
inline uint32_t mostTiles(uint32_t elements, uint32_t lanesOfWarp) {
  const uint32_t least = leastInSum(lanesOfWarp),
                 tiles = uint32_t((uint64_t(elements) + least - 1) / least);
  return tiles < mostTilesOfSum ? tiles : mostTilesOfSum;
}

/// For each row of a tile: row(element, isElement), on all lanes of the warp.
template <typename Row>
void forEachRow(uint32_t tile, uint32_t elementsOfTile, uint32_t lane, uint32_t elements, Row row) {
  const uint64_t first = uint64_t(tile) * elementsOfTile;
  for (uint32_t i = 0; i < elementsOfTile && first + i < elements; i += lanes)
    row(uint32_t(first) + i + lane, first + i + lane < elements);
}

} // namespace rtsl::device::build
