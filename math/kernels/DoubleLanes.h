// Four doubles that are computed at once, for functions of the components of a vector: the same
// operations as on one double, so the same bits. For the host, with AVX2 and FMA.
#pragma once

#include "math/kernels/Bits.h"

#include <immintrin.h>

namespace rtsl::device::detail {

class DoubleLanes {
public:
  /// Not explicit: coefficients are equal in all lanes.
  DoubleLanes(double x) : lanes(_mm256_set1_pd(x)) {}
  explicit DoubleLanes(__m256d lanes) : lanes(lanes) {}

  __m256d vector() const { return lanes; }
  __m256i bits() const { return _mm256_castpd_si256(lanes); }

  friend DoubleLanes operator+(DoubleLanes a, DoubleLanes b) {
    return DoubleLanes(_mm256_add_pd(a.lanes, b.lanes));
  }
  friend DoubleLanes operator-(DoubleLanes a, DoubleLanes b) {
    return DoubleLanes(_mm256_sub_pd(a.lanes, b.lanes));
  }
  friend DoubleLanes operator*(DoubleLanes a, DoubleLanes b) {
    return DoubleLanes(_mm256_mul_pd(a.lanes, b.lanes));
  }
  friend DoubleLanes fma(DoubleLanes a, DoubleLanes b, DoubleLanes c) {
    return DoubleLanes(_mm256_fmadd_pd(a.lanes, b.lanes, c.lanes));
  }

private:
  __m256d lanes;
};

/// Whether all lanes of a comparison are true.
inline bool allTrue(__m256i comparison) {
  return _mm256_movemask_epi8(comparison) == -1;
}
inline bool allTrue(__m128i comparison) {
  return _mm_movemask_epi8(comparison) == 0xffff;
}

} // namespace rtsl::device::detail
