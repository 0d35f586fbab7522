//===- Normals.h - normals of length 1 ------------------------------------===//
#pragma once

#include "support/Parallel.h"

#include <cmath>
#include <cstddef>
#include <vector>

namespace rtsl::runtime {

/// Normals of files may have any length; for interpolation all must have the same weight. Zeros
/// stay.
inline void normalize(std::vector<float> &normals) {
  forRangesInParallel(0, normals.size() / 3, 1 << 16, [&](std::size_t first, std::size_t end) {
    for (std::size_t i = 3 * first; i < 3 * end; i += 3) {
      const double x = normals[i], y = normals[i + 1], z = normals[i + 2];
      const double length = std::sqrt(x * x + y * y + z * z);
      for (std::size_t axis = 0; axis < 3 && length > 0; ++axis)
        normals[i + axis] = float(normals[i + axis] / length);
    }
  });
}

} // namespace rtsl::runtime
