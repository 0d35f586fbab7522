// pow of four pairs of numbers at once, with the same bits as pow of each: for powers of colors, by
// component. For the host.
#pragma once

#include "math/Power.h"
#include "math/kernels/DoubleLanes.h"

namespace rtsl::device {

namespace detail {

/// table(lane) in each lane.
template <typename Table>
inline DoubleLanes lookUp(Table table) {
  return DoubleLanes(_mm256_set_pd(table(3), table(2), table(1), table(0)));
}

/// ln(x) in plain double, for positive normal x; see reduceLogarithmOfNormal().
inline DoubleLanes plainLogarithm(__m128 x) {
  __m128i bits = _mm_castps_si128(x);
  __m128i distance = _mm_sub_epi32(bits, _mm_set1_epi32(int(bitsOf(0.6875f))));
  __m128i exponent = _mm_srai_epi32(distance, 23);
  __m128i mantissa = _mm_sub_epi32(bits, _mm_slli_epi32(exponent, 23));
  alignas(16) int cells[4];
  _mm_store_si128(reinterpret_cast<__m128i *>(cells),
                  _mm_and_si128(_mm_srli_epi32(distance, 16), _mm_set1_epi32(127)));

  DoubleLanes inverse = lookUp([&](int i) { return logarithmTable[cells[i]].inverse; });
  DoubleLanes hi = lookUp([&](int i) { return logarithmTable[cells[i]].hi; });
  DoubleLanes lo = lookUp([&](int i) { return logarithmTable[cells[i]].lo; });
  DoubleLanes r = fma(DoubleLanes(_mm256_cvtps_pd(_mm_castsi128_ps(mantissa))), inverse, -1.0);
  return plainLogarithm<DoubleLanes>(DoubleLanes(_mm256_cvtepi32_pd(exponent)), hi, lo, r);
}

/// e^x; see plainExponential().
inline DoubleLanes plainExponential(DoubleLanes x) {
  DoubleLanes shifted = x * exponentialStepsPerUnit + integerShifter;
  DoubleLanes remainder = fma(integerShifter - shifted, exponentialStepSize, x);
  DoubleLanes tail = plainExponentialTail<DoubleLanes>(remainder);
  alignas(32) int64_t steps[4];
  _mm256_store_si256(reinterpret_cast<__m256i *>(steps), shifted.bits());
  constexpr int last = exponentialTableSize - 1;
  DoubleLanes entry = lookUp([&](int i) { return exponentialTable[steps[i] & last].hi; });
  // Shift Step/64 into the exponent: the bits above the step's 32 are shifted out.
  __m256i exponent = _mm256_slli_epi64(_mm256_srli_epi64(shifted.bits(), 6), 52);
  __m256i one = _mm256_castpd_si256(_mm256_set1_pd(1.0));
  DoubleLanes scale(_mm256_castsi256_pd(_mm256_add_epi64(exponent, one)));
  return scale * fma(entry, tail, entry);
}

/// Whether roundsSafely(double) is true of all lanes.
inline bool roundSafely(DoubleLanes y) {
  __m256i distance = _mm256_sub_epi64(y.bits(), _mm256_set1_epi64x(roundingMidpoint - plainMargin));
  distance = _mm256_and_si256(distance, _mm256_set1_epi64x(2 * roundingMidpoint - 1));
  return allTrue(_mm256_cmpgt_epi64(distance, _mm256_set1_epi64x(2 * plainMargin)));
}

[[gnu::cold, gnu::const, gnu::noinline]] inline __m128 powerOneByOne(__m128 x, __m128 y) {
  alignas(16) float bases[4], exponents[4];
  _mm_store_ps(bases, x);
  _mm_store_ps(exponents, y);
  for (int i = 0; i < 4; ++i)
    bases[i] = device::pow(bases[i], exponents[i]);
  return _mm_load_ps(bases);
}

} // namespace detail

/// x^y in each lane.
inline __m128 pow(__m128 x, __m128 y) {
  using namespace detail;
  // As integers, positive floats are ordered, and all others are below or above.
  __m128i base = _mm_castps_si128(x);
  __m128i magnitude = _mm_and_si128(_mm_castps_si128(y), _mm_set1_epi32(0x7fffffff));
  __m128i infinity = _mm_set1_epi32(int(floatInfinityBits));
  __m128i plain = _mm_and_si128(_mm_cmpgt_epi32(base, _mm_set1_epi32(0x007fffff)),
                                _mm_cmpgt_epi32(infinity, base));
  if (allTrue(_mm_and_si128(plain, _mm_cmpgt_epi32(infinity, magnitude)))) {
    DoubleLanes exponent = DoubleLanes(_mm256_cvtps_pd(y)) * plainLogarithm(x);
    __m256d inRange =
        _mm256_and_pd(_mm256_cmp_pd(exponent.vector(), _mm256_set1_pd(-87.0), _CMP_GE_OQ),
                      _mm256_cmp_pd(exponent.vector(), _mm256_set1_pd(89.0), _CMP_LE_OQ));
    if (allTrue(_mm256_castpd_si256(inRange))) {
      DoubleLanes power = plainExponential(exponent);
      if (roundSafely(power))
        return _mm256_cvtpd_ps(power.vector());
    }
  }
  return powerOneByOne(x, y);
}

} // namespace rtsl::device
