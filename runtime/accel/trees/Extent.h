//===- Extent.h - the box of other boxes, in vectors ----------------------===//
#pragma once

#include "runtime/device/ray/Launch.h"

#include <immintrin.h>

#include <limits>

namespace rtsl::runtime {

/// Vectors of x, y, z, and a number that does not matter.
struct Extent {
  __m128 lower = _mm_set1_ps(std::numeric_limits<float>::infinity());
  __m128 upper = _mm_set1_ps(-std::numeric_limits<float>::infinity());

  void add(__m128 low, __m128 high) {
    lower = _mm_min_ps(lower, low);
    upper = _mm_max_ps(upper, high);
  }
  void add(const Extent &other) { add(other.lower, other.upper); }

  /// Half of the surface; of an empty one 0.
  double area() const {
    alignas(16) float side[4];
    _mm_store_ps(side, _mm_max_ps(_mm_sub_ps(upper, lower), _mm_setzero_ps()));
    return double(side[0]) * side[1] + double(side[1]) * side[2] + double(side[2]) * side[0];
  }

  /// A factor for each axis, by which distances from `lower` become numbers below `cells`; 0 for an
  /// axis along which the boxes cannot be distinguished.
  __m128 scaleTo(float cells) const {
    const __m128 side = _mm_sub_ps(upper, lower);
    const __m128 scale = _mm_div_ps(_mm_set1_ps(cells * 0.9999f), side);
    return _mm_and_ps(scale, _mm_cmpgt_ps(side, _mm_set1_ps(1e-30f)));
  }

  RtslBox bounds() const {
    return {{lower[0], lower[1], lower[2]}, {upper[0], upper[1], upper[2]}};
  }
};

} // namespace rtsl::runtime
