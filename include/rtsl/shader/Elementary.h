//===- Elementary.h - sin, pow, sqrt and similar functions ----------------===//
//
// Correctly rounded: the functions of the runtime library, compiled from the source that the
// compiler's own machine code uses (math). With RTSL_FAST they are those of the C library.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "rtsl/shader/Common.h"

// clang-format off
/// X(name) for each function of one number that C has as well.
#define RTSL_ELEMENTARY_FUNCTIONS(X)                                                               \
  X(sin) X(cos) X(tan) X(asin) X(acos) X(atan) X(sinh) X(cosh) X(tanh) X(asinh)                    \
  X(acosh) X(atanh) X(exp) X(exp2) X(expm1) X(log) X(log2) X(log1p)
// clang-format on

extern "C" {
#define RTSL_DECLARE(name) float rtsl_##name(float x);
RTSL_ELEMENTARY_FUNCTIONS(RTSL_DECLARE)
#undef RTSL_DECLARE
float rtsl_sinpi(float x);
float rtsl_cospi(float x);
float rtsl_inversesqrt(float x);
float rtsl_atan2(float y, float x);
float rtsl_pow(float x, float y);
#if defined(__SSE2__)
__m128 rtsl_pow4(__m128 x, __m128 y); // in each lane; the same bits, faster
#endif
}

namespace rtsl {
inline namespace RTSL_VARIANT {

#if defined(RTSL_FAST)
#define RTSL_ELEMENTARY(name) std::name
#else
#define RTSL_ELEMENTARY(name) rtsl_##name
#endif
#define RTSL_DEFINE(name)                                                                          \
  template <typename T>                                                                            \
  inline auto name(const T &value) {                                                               \
    return each([](float x) { return RTSL_ELEMENTARY(name)(x); }, value);                          \
  }
RTSL_ELEMENTARY_FUNCTIONS(RTSL_DEFINE)
#undef RTSL_DEFINE
#undef RTSL_ELEMENTARY_FUNCTIONS

// sin(pi x) and cos(pi x), which the C library does not have yet.
template <typename T>
inline auto sinpi(const T &value) {
  return each([](float x) { return rtsl_sinpi(x); }, value);
}
template <typename T>
inline auto cospi(const T &value) {
  return each([](float x) { return rtsl_cospi(x); }, value);
}

template <typename T>
inline auto inversesqrt(const T &value) {
#if defined(RTSL_FAST)
  return each([](float x) { return 1.0f / squareRoot(x); }, value);
#else
  return each([](float x) { return rtsl_inversesqrt(x); }, value);
#endif
}
template <typename Y, typename X>
inline auto atan(const Y &a, const X &b) {
  return each([](float y, float x) { return RTSL_ELEMENTARY(atan2)(y, x); }, a, b);
}

namespace detail {
#if defined(__SSE2__)
/// Components from 4 * Block on; 1 beyond the last one.
template <int Block, int Count, typename T>
inline __m128 lanesOf(const T &v) {
  const auto at = [&](auto lane) {
    constexpr int index = 4 * Block + decltype(lane)::value;
    if constexpr (index < Count)
      return part<index>(v);
    else
      return 1.0f;
  };
  return _mm_setr_ps(at(std::integral_constant<int, 0>()), at(std::integral_constant<int, 1>()),
                     at(std::integral_constant<int, 2>()), at(std::integral_constant<int, 3>()));
}

template <int Count, typename X, typename Y, int... Block>
inline void powers(const X &base, const Y &exponent, float *results,
                   std::integer_sequence<int, Block...>) {
  (_mm_store_ps(results + 4 * Block,
                rtsl_pow4(lanesOf<Block, Count>(base), lanesOf<Block, Count>(exponent))),
   ...);
}

template <typename T, int... I>
inline void setParts(T &v, const float *values, std::integer_sequence<int, I...>) {
  if constexpr (isColor<T>)
    ((v.components[I] = values[I]), ...);
  else
    ((v[I] = values[I]), ...);
}
#endif
} // namespace detail

template <typename X, typename Y>
inline auto pow(const X &base, const Y &exponent) {
#if defined(__SSE2__)
  if constexpr (constexpr int count = std::max(width<X>, width<Y>); count > 1) {
    constexpr int blocks = (count + 3) / 4;
    alignas(16) float results[4 * blocks];
    detail::powers<count>(base, exponent, results, std::make_integer_sequence<int, blocks>());
    auto power = each([](float x, float) { return x; }, base, exponent); // its type
    detail::setParts(power, results, std::make_integer_sequence<int, count>());
    return power;
  } else
#endif
    return each([](float x, float y) { return RTSL_ELEMENTARY(pow)(x, y); }, base, exponent);
}
#undef RTSL_ELEMENTARY

/// By squaring, from the lowest bit of |exponent|; for a negative exponent the reciprocal is taken
/// at the end. Each step rounds, so the error is below |exponent| ulp.
template <typename T>
constexpr auto powi(const T &value, int exponent) {
  return each(
      [](float base, int n) {
        float result = 1.0f;
        for (uint rest = n < 0 ? 0u - static_cast<uint>(n) : static_cast<uint>(n); rest != 0;) {
          if ((rest & 1u) != 0)
            result = result * base;
          rest >>= 1;
          if (rest != 0)
            base = base * base;
        }
        return n < 0 ? 1.0f / result : result;
      },
      value, exponent);
}

template <typename T>
inline auto sqrt(const T &value) {
  return each([](float x) { return rtsl::squareRoot(x); }, value);
}
template <typename T>
inline auto radians(const T &degrees) {
  return each([](float x) { return x * static_cast<float>(3.14159265358979323846 / 180); },
              degrees);
}
template <typename T>
inline auto degrees(const T &radians) {
  return each([](float x) { return x * static_cast<float>(180 / 3.14159265358979323846); },
              radians);
}

} // namespace RTSL_VARIANT
} // namespace rtsl
