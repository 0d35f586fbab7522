//===- EightRanges.h - the parts of a ray in eight boxes at once ----------===//
//
// The operations of BoxRange.h in the same order, and so with the same bits, in the lanes of a
// vector. For the host: its processors have AVX 2.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/traverse/BoxRange.h"

#include <immintrin.h>
#include <stdint.h>

namespace rtsl::device {

struct EightRanges {
  __m256 near = _mm256_setzero_ps(), far = _mm256_set1_ps(infinity);

  /// rangeInBox along one axis, by the coordinates of the sides where the ray enters the boxes and
  /// where it leaves them.
  [[gnu::always_inline]] void narrow(__m256 enters, __m256 leaves, float origin, float inverse) {
    const __m256 o = _mm256_set1_ps(origin), i = _mm256_set1_ps(inverse);
    near = _mm256_max_ps((enters - o) * i, near); // if the first is NaN, the second
    far = _mm256_min_ps((leaves - o) * i, far);
  }

  /// Widens the ranges. Returns, as bits, which of them were not empty, and have a part between
  /// tMin and tMax.
  [[gnu::always_inline]] uint32_t widen(float tMin, float tMax) {
    const __m256 isMet = _mm256_cmp_ps(near, far * _mm256_set1_ps(bvhSlack), _CMP_LE_OQ);
    near = near * _mm256_set1_ps(1.0f - rangeShare);
    far = far * _mm256_set1_ps(1.0f + rangeShare);
    const __m256 isInRange = _mm256_and_ps(_mm256_cmp_ps(near, _mm256_set1_ps(tMax), _CMP_LE_OQ),
                                           _mm256_cmp_ps(far, _mm256_set1_ps(tMin), _CMP_GE_OQ));
    return uint32_t(_mm256_movemask_ps(_mm256_and_ps(isMet, isInRange)));
  }
};

} // namespace rtsl::device
