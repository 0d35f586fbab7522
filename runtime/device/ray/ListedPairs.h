//===- ListedPairs.h - boxes of a list, two at once -----------------------===//
//
// The first test of a scene without a tree (ListedBox.h), in half precision: a GPU has instructions
// for two halves at once. Coordinates are moved and scaled so that all boxes are within [-1, 1],
// and distances are scaled with them. Boxes are enlarged by a bound of what is rounded, so this
// test, too, finds every box in which rangeInBox finds a range; docs/gpu.md has the proof. The
// compiler uses it where that enlarges the boxes of the scene by little
// (codegen/link/ListedPairs.h).
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/ray/Abi.h"
#include "runtime/device/ray/HalfPair.h"
#include "runtime/device/ray/Vector.h"

namespace rtsl::device {

/// So many pairs are tested together.
constexpr uint32_t pairsAtOnce = 2;

/// The pairs of a list of so many boxes, at most 32: the first boxes of all pairs, then the second
/// ones. Some of these may be unused.
inline uint32_t pairCount(uint32_t boxes) {
  return (boxes + 2 * pairsAtOnce - 1) / (2 * pairsAtOnce) * pairsAtOnce;
}

/// The set that enteredInPairs gives: bit i is for the first box of pair i, bit 16 + i for the
/// second one.
inline uint32_t instanceOfBit(uint32_t bit, uint32_t count) {
  return bit < 16 ? bit : bit - 16 + pairCount(count);
}
inline uint32_t bitOfInstance(uint32_t instance, uint32_t count) {
  return instance < pairCount(count) ? instance : instance - pairCount(count) + 16;
}

#ifdef __clang__ // HalfPair.h
/// An axis of a ray that tests pairs of boxes.
struct ListedPairsAxis {
  float distance;    // at which the axis has the coordinate 0
  HalfPair toOrigin; // the same
  HalfPair inverse;  // of the direction, whose largest component counts as 1
  HalfPair size;     // of the inverse

  /// Along an axis whose distances would not be in the range of a half, or are NaN, no box is left
  /// out: with an infinite inverse their sides are at infinite or undefined distances.
  ListedPairsAxis(float origin, float inverse)
      : distance(-origin * inverse), toOrigin(both(distance)),
        inverse(both(used(inverse, distance))), size(both(absolute(used(inverse, distance)))) {}

private:
  static float used(float inverse, float distance) {
    return raised(absolute(inverse), absolute(distance)) < 0x1p14f ? inverse : infinity;
  }
};

/// A ray that tests pairs of boxes between two distances.
class ListedPairsRay {
public:
  /// `inverse`: of the direction, by component.
  ListedPairsRay(const RtslListedPairs &list, Vec3 origin, Vec3 direction, Vec3 inverse, float tMin,
                 float tMax)
      : ListedPairsRay(list, origin, inverse, largest(direction), largest(direction) * list.scale,
                       tMin, tMax) {}

  /// Bits 15 and 31 are 1 if the ray is not in the first and the second box.
  uint32_t outside(const RtslListedPair &boxes) const {
    const HalfPair tx = fused(pairOf(boxes.middle[0]), x.inverse, x.toOrigin),
                   ty = fused(pairOf(boxes.middle[1]), y.inverse, y.toOrigin),
                   tz = fused(pairOf(boxes.middle[2]), z.inverse, z.toOrigin);
    const HalfPair hx = pairOf(boxes.half[0]), hy = pairOf(boxes.half[1]),
                   hz = pairOf(boxes.half[2]);
    const HalfPair near =
        larger(larger(larger(tMin, fused(-hx, x.size, tx)), fused(-hy, y.size, ty)),
               fused(-hz, z.size, tz));
    const HalfPair far =
        smaller(smaller(smaller(tMax, fused(hx, x.size, tx)), fused(hy, y.size, ty)),
                fused(hz, z.size, tz));
    return bitsOf((far + slack) + -near) & 0x80008000u; // of NaN: 0
  }

private:
  /// `unit`: what distances are multiplied with.
  ListedPairsRay(const RtslListedPairs &list, Vec3 origin, Vec3 inverse, float length, float unit,
                 float tMin, float tMax)
      : ListedPairsRay(list, origin, inverse, length, unit > 0x1p-100f && unit < 0x1p100f,
                       tMin * unit, tMax * unit) {}
  /// If the unit is not usual, all boxes are entered.
  ListedPairsRay(const RtslListedPairs &list, Vec3 origin, Vec3 inverse, float length, bool isUsual,
                 float tMin, float tMax)
      : ListedPairsRay({fused(origin.x, list.scale, list.offset[0]),
                        fused(origin.y, list.scale, list.offset[1]),
                        fused(origin.z, list.scale, list.offset[2])},
                       inverse * (isUsual ? length : infinity), isUsual ? tMin : 0,
                       isUsual ? tMax : infinity) {}
  ListedPairsRay(Vec3 origin, Vec3 inverse, float tMin, float tMax)
      : x(origin.x, inverse.x), y(origin.y, inverse.y), z(origin.z, inverse.z),
        slack(both(fused((absolute(x.distance) + absolute(y.distance)) + absolute(z.distance),
                         0x1p-8f, 0x1p-18f))),
        // Rounded down and up, and a box must not be beyond tMin because that is infinite.
        tMin(both(lowered(0x1p15f, tMin * (1 - 0x1p-9f)))), tMax(both(tMax * (1 + 0x1p-9f))) {}

  ListedPairsAxis x, y, z;
  HalfPair slack; // bounds the roundings of toOrigin
  HalfPair tMin, tMax;
};

/// The boxes that the ray may enter of a list of `count`, at most 32, as a set of bits.
inline uint32_t enteredInPairs(const RtslListedPairs &list, uint32_t count,
                               const ListedPairsRay &ray) {
  const uint32_t pairs = pairCount(count), seconds = count > pairs ? count - pairs : 0;
  const auto *boxes = static_cast<const RtslListedPair *>(__builtin_assume_aligned(&list + 1, 16));
  uint32_t outside = 0;
  for (uint32_t first = 0; first < pairs; first += pairsAtOnce) {
#pragma clang loop unroll(full)
    for (uint32_t i = 0; i < pairsAtOnce; ++i)
      outside = outside >> 1 | ray.outside(boxes[first + i]);
  }
  return ~(outside >> (16 - pairs)) & (((1u << pairs) - 1) | ((1u << seconds) - 1) << 16);
}
#endif

} // namespace rtsl::device
