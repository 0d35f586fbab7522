//===- Color.h - operations on the components of a color ------------------===//
#pragma once

#include "runtime/device/ray/Launch.h"

namespace rtsl::device {

/// Calls visit(i) for each component of a color. Unrolled, so that each has a constant address:
/// then a color can be in registers.
template <typename Visit>
inline void forEachComponent(uint32_t components, Visit visit) {
#ifdef __clang__
#pragma clang loop unroll(full)
#endif
  for (uint32_t i = 0; i < RTSL_MAX_COLOR; ++i)
    if (i < components)
      visit(i);
}

// Loops over a few components become calls of memset and memcpy, which cost more than the loop; so
// the usual number of components is written out.
inline void setColor(float *color, uint32_t components, float value) {
  if (components == 3) {
    color[0] = color[1] = color[2] = value;
    return;
  }
  forEachComponent(components, [&](uint32_t i) { color[i] = value; });
}

inline void copyColor(float *to, const float *from, uint32_t components) {
  if (components == 3) {
    float r = from[0], g = from[1], b = from[2];
    to[0] = r, to[1] = g, to[2] = b;
    return;
  }
  forEachComponent(components, [&](uint32_t i) { to[i] = from[i]; });
}

inline bool isBlack(const float *color, uint32_t components) {
  bool isBlack = true;
  forEachComponent(components, [&](uint32_t i) { isBlack &= color[i] == 0; });
  return isBlack;
}

} // namespace rtsl::device
