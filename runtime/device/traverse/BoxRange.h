//===- BoxRange.h - the part of a ray in a box ----------------------------===//
#pragma once

#include "runtime/device/ray/Vector.h"

namespace rtsl::device {

/// A ray meets a box if it leaves it no earlier than it enters it, within this factor. That covers
/// three roundings of each distance (Ize, "Robust BVH Ray Traversal", JCGT 2(2), 2013: 1 + 2
/// gamma(3)), and as much again for those of intersectTriangle.
constexpr float bvhSlack = 1.0f + 16 * roundingUnit;

/// The contents of a box are hit within the ray's range in the box, up to this share of the
/// distance: hits of triangles are moved into it (TestItem.h), those of RTSL primitives are
/// compared as if they were in it (Hit.h). So a box that begins beyond the nearest hit by more than
/// two such shares contains nothing that could win, and the result does not depend on which boxes a
/// traversal enters, in any tree and any order. That holds for outer boxes too, because rounding is
/// monotonic: of two nested boxes, the outer one begins no later and ends no earlier, to the bit.
constexpr float rangeShare = 0x1p-12f;
constexpr float cullSlack = 1.0f + 2 * rangeShare;

/// The part of a ray in a box.
struct Range {
  float near, far;

  bool isEmpty() const { return !(near <= far * bvhSlack); }
  /// The range enlarged on both sides by rangeShare of its distances: where hits in the box may be.
  Range widened() const { return {near * (1.0f - rangeShare), far * (1.0f + rangeShare)}; }
};

/// The point of a range that is nearest to t.
inline float movedInto(Range range, float t) {
  return t < range.near ? range.near : t > range.far ? range.far : t;
}

/// The range of the ray in the box and between tMin and tMax. If a component of the direction is 0,
/// `inverse` is infinite, and 0 * inf is NaN for an origin in the plane of a side: comparisons are
/// written so that this leaves the range as it is.
inline Range rangeInBox(const float lower[3], const float upper[3], Vec3 origin, Vec3 inverse,
                        float tMin, float tMax) {
  float near = tMin, far = tMax;
  // All are loaded, so that a GPU can load several at once.
  const Vec3 low = load(lower), high = load(upper);
  float x0 = ((inverse.x < 0 ? high.x : low.x) - origin.x) * inverse.x;
  float x1 = ((inverse.x < 0 ? low.x : high.x) - origin.x) * inverse.x;
  float y0 = ((inverse.y < 0 ? high.y : low.y) - origin.y) * inverse.y;
  float y1 = ((inverse.y < 0 ? low.y : high.y) - origin.y) * inverse.y;
  float z0 = ((inverse.z < 0 ? high.z : low.z) - origin.z) * inverse.z;
  float z1 = ((inverse.z < 0 ? low.z : high.z) - origin.z) * inverse.z;
  near = raised(raised(raised(near, x0), y0), z0);
  far = lowered(lowered(lowered(far, x1), y1), z1);
  return {near, far};
}

/// Where the ray enters the box, or infinity if it does not between tMin and tMax.
inline float enterBox(const float lower[3], const float upper[3], Vec3 origin, Vec3 inverse,
                      float tMin, float tMax) {
  Range range = rangeInBox(lower, upper, origin, inverse, tMin, tMax);
  return range.isEmpty() ? infinity : range.near;
}

} // namespace rtsl::device
