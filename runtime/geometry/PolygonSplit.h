//===- PolygonSplit.h - quadrilaterals as triangles -----------------------===//
#pragma once

#include <array>

namespace rtsl::runtime {

/// The corner of a quadrilateral from which an inner diagonal starts: the reflex one if there is
/// one, otherwise the first. Corners are x, y, z in order around it.
inline int cornerOfDiagonal(const std::array<const float *, 4> &corners) {
  using Vector = std::array<double, 3>;
  auto between = [&](int from, int to) -> Vector {
    const float *a = corners[from & 3], *b = corners[to & 3];
    return {double(b[0]) - a[0], double(b[1]) - a[1], double(b[2]) - a[2]};
  };
  auto cross = [](const Vector &a, const Vector &b) -> Vector {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  };
  const Vector normal = cross(between(0, 2), between(1, 3));
  for (int i = 0; i < 4; ++i) {
    const Vector turn = cross(between(i + 3, i), between(i, i + 1));
    if (turn[0] * normal[0] + turn[1] * normal[1] + turn[2] * normal[2] < 0)
      return i;
  }
  return 0;
}

} // namespace rtsl::runtime
