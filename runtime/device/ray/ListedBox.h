//===- ListedBox.h - the boxes of a scene without a tree ------------------===//
//
// A scene of a few primitives has no tree: a ray tests the boxes of all of them (LaunchTree.h), and
// then the primitives whose boxes it may enter. This first test must find every box in which
// rangeInBox finds a range; it may find others, because the primitive's own test decides. So a box
// is stored as its middle and half of its size, enlarged by a bound of all roundings: three fused
// operations an axis, and no choice between lower and upper sides. docs/gpu.md has the proof. The
// host's own code tests the exact boxes instead (ListTraversal.cpp).
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/ray/Abi.h"
#include "runtime/device/ray/Vector.h"

namespace rtsl::device {

/// The box around these sides, each of which may be infinite.
inline RtslListedBox listedBox(const float lower[3], const float upper[3]) {
  RtslListedBox box{};
  for (int axis = 0; axis < 3; ++axis) {
    const double low = lower[axis], high = upper[axis];
    const auto middle = float((low + high) / 2);
    const double half = high - middle > middle - low ? high - middle : middle - low;
    const double enlarged = half + 0x1p-19 * (half + (middle < 0 ? -middle : middle)) + 0x1p-126;
    const bool isFinite = enlarged < 0x1p62;
    box.middle[axis] = isFinite ? middle : 0;
    box.half[axis] = isFinite ? float(enlarged) : infinity;
  }
  return box;
}

/// An axis of a ray that tests listed boxes.
struct ListedBoxAxis {
  float inverse;  // of the direction
  float toOrigin; // the distance at which the axis has the coordinate 0
  float size;     // of toOrigin

  /// An axis along which distances are too large, or NaN, excludes no box: with an infinite inverse
  /// the sides are at infinite or undefined distances.
  ListedBoxAxis(float origin, float inverse) : inverse(inverse), toOrigin(-origin * inverse) {
    if (!(absolute(inverse) < 0x1p60f && absolute(toOrigin) < 0x1p100f)) {
      this->inverse = infinity;
      toOrigin = 0;
    }
    size = absolute(toOrigin);
  }
};

/// A ray that tests listed boxes.
struct ListedBoxRay {
  ListedBoxAxis x, y, z;
  float slack; // bounds the roundings of toOrigin

  ListedBoxRay(Vec3 origin, Vec3 inverse)
      : x(origin.x, inverse.x), y(origin.y, inverse.y), z(origin.z, inverse.z),
        slack(fused((x.size + y.size) + z.size, 32 * roundingUnit, 0x1p-120f)) {}

  /// Whether the ray may be in the box between tMin and tMax.
  bool mayEnter(const RtslListedBox &box, float tMin, float tMax) const {
    const float tx = fused(box.middle[0], x.inverse, x.toOrigin),
                ty = fused(box.middle[1], y.inverse, y.toOrigin),
                tz = fused(box.middle[2], z.inverse, z.toOrigin);
    const float wx = absolute(x.inverse), wy = absolute(y.inverse), wz = absolute(z.inverse);
    const float near =
        raised(raised(raised(tMin, fused(-box.half[0], wx, tx)), fused(-box.half[1], wy, ty)),
               fused(-box.half[2], wz, tz));
    const float far =
        lowered(lowered(lowered(tMax, fused(box.half[0], wx, tx)), fused(box.half[1], wy, ty)),
                fused(box.half[2], wz, tz));
    return !(near > fused(far, 1 + 32 * roundingUnit, slack));
  }
};

/// Is the ray in the box only before tMin, if at all? True only if rangeInBox finds no range there;
/// and never for rays along an axis, nearly.
inline bool endsBefore(const RtslListedBox &box, Vec3 origin, Vec3 inverse, float tMin) {
  const auto end = [&](int axis) { // where the ray leaves, along an axis
    const float half = fused(absolute(origin[axis]), 8 * roundingUnit, box.half[axis]);
    return fused(half, absolute(inverse[axis]), (box.middle[axis] - origin[axis]) * inverse[axis]);
  };
  const float far = lowered(lowered(lowered(infinity, end(0)), end(1)), end(2));
  return far < tMin * (1 - 32 * roundingUnit) && largest(inverse) < 0x1p60f;
}

} // namespace rtsl::device
