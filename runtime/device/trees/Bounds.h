//===- Bounds.h - boxes of a tree -----------------------------------------===//
#pragma once

#include "runtime/device/ray/Launch.h"
#include "runtime/device/ray/Vector.h"

namespace rtsl::device::build {

/// An empty box, to be extended.
inline RtslBox emptyBox() {
  return {{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
}

inline void extend(RtslBox &box, const RtslBox &by) {
  for (int axis = 0; axis < 3; ++axis) {
    box.lower[axis] = lowered(box.lower[axis], by.lower[axis]);
    box.upper[axis] = raised(box.upper[axis], by.upper[axis]);
  }
}

/// Half the area of the box's surface; of huge boxes infinity or NaN.
inline float halfArea(const RtslBox &box) {
  const float x = box.upper[0] - box.lower[0], y = box.upper[1] - box.lower[1],
              z = box.upper[2] - box.lower[2];
  return x < 0 ? 0 : x * y + y * z + z * x;
}

} // namespace rtsl::device::build
