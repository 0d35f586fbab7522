//===- Box.h - the boxes of primitives ------------------------------------===//
#pragma once

#include "runtime/device/ray/Abi.h"
#include "runtime/device/ray/Vector.h"

namespace rtsl::device {

/// Products of sides must not overflow; an infinite primitive gets the largest box.
constexpr float largestSide = 1e18f;
constexpr float smallestNormal = 0x1p-126f;

/// A side of a box, a few units in the last place outwards, because its author's sums are rounded.
/// `towards` is 1 or -1.
inline float outwards(float side, float towards) {
  const float moved = side + towards * (absolute(side) * 0x1p-21f + smallestNormal);
  return moved < -largestSide ? -largestSide : moved > largestSide ? largestSide : moved;
}

/// The box of a primitive with these bounds.
inline RtslBox enlarged(const RtslBox &bounds) {
  RtslBox box;
  for (int i = 0; i < 3; ++i) {
    box.lower[i] = outwards(bounds.lower[i], -1);
    box.upper[i] = outwards(bounds.upper[i], 1);
  }
  return box;
}

/// Is there an object with several primitives? Folds to a constant in a compiled program.
inline bool hasCounts(const RtslLaunch &launch) {
  return (rtsl_needs(&launch) & RTSL_HAS_COUNTS) != 0;
}
/// Does the instance hold several primitives of an object?
inline bool isCounted(const RtslLaunch &launch, const RtslInstance &instance) {
  return instance.boxCount != 0 && hasCounts(launch);
}

/// The bounds of a primitive, from `computeBounds`, in object space.
inline RtslBox boundsOf(const RtslLaunch &launch, const RtslInstance &instance,
                        uint32_t primitive) {
  if (isCounted(launch, instance))
    return launch.boxes[instance.firstBox + primitive];
  RtslBox bounds;
  for (int i = 0; i < 3; ++i) {
    bounds.lower[i] = instance.boundMin[i];
    bounds.upper[i] = instance.boundMax[i];
  }
  return bounds;
}

/// The box of a primitive for traversal: in world space, but of an object with several primitives
/// in object space.
inline RtslBox boxOf(const RtslLaunch &launch, const RtslInstance &instance, uint32_t primitive) {
  if (isCounted(launch, instance))
    return enlarged(launch.boxes[instance.firstBox + primitive]);
  RtslBox box;
  for (int i = 0; i < 3; ++i) {
    box.lower[i] = instance.lower[i];
    box.upper[i] = instance.upper[i];
  }
  return box;
}

} // namespace rtsl::device
