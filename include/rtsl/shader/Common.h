//===- Common.h - min, mix, floor and similar functions -------------------===//
//
// The rules are those of docs/language.md, chapters 3 and 4.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "rtsl/shader/Types.h"

#include <cmath>
#if defined(__SSE2__)
#include <immintrin.h>
#endif
#include <cstring>
#include <limits>

namespace rtsl {
inline namespace RTSL_VARIANT {

inline constexpr float infinity = std::numeric_limits<float>::infinity();

/// The 32 bits of a number as those of another type.
template <typename To, typename From>
inline To bitsAs(From from) {
  static_assert(sizeof(To) == 4 && sizeof(From) == 4);
  To to;
  std::memcpy(&to, &from, 4);
  return to;
}

/// For a condition that is nearly always true.
constexpr bool isLikely(bool choice) {
#if defined(__GNUC__)
  return __builtin_expect(choice, true);
#else
  return choice;
#endif
}

/// Keeps a value that each iteration of a loop passes to a call in memory: g++ would put it into a
/// register, and save and restore it around each call.
template <typename T>
inline void keepInMemory([[maybe_unused]] T &value) {
#if defined(__GNUC__)
  asm("" : "+m"(value));
#endif
}

/// The IEEE square root: one instruction. std::sqrt also checks each time whether errno is to be
/// set, and with the intrinsic g++ clears the register's other lanes first.
inline float squareRoot(float x) {
#if defined(__AVX__) && defined(__GNUC__) && !defined(__clang__)
  if (!__builtin_constant_p(x)) {
    float root;
    asm("vsqrtss %1, %1, %0" : "=x"(root) : "x"(x));
    return root;
  }
#elif defined(__SSE2__)
  return _mm_cvtss_f32(_mm_sqrt_ss(_mm_set_ss(x)));
#endif
  return std::sqrt(x);
}

//===----------------------------------------------------------------------===//
// Conversions: float to integer truncates and saturates; NaN gives 0
//===----------------------------------------------------------------------===//

template <typename T>
inline auto toInt(const T &value) {
  return each(
      [](float x) {
        if (!(x > -2147483648.0f)) // or NaN
          return x < 0.0f ? std::numeric_limits<int>::min() : 0;
        return x < 2147483648.0f ? static_cast<int>(x) : std::numeric_limits<int>::max();
      },
      value);
}
template <typename T>
inline auto toUint(const T &value) {
  return each(
      [](float x) {
        if (!(x > 0.0f)) // or NaN
          return 0u;
        return x < 4294967296.0f ? static_cast<uint>(x) : std::numeric_limits<uint>::max();
      },
      value);
}

//===----------------------------------------------------------------------===//
// Minima, maxima and selection
//===----------------------------------------------------------------------===//

/// y < x ? y : x: a NaN in x is returned, a NaN in y is ignored.
template <typename X, typename Y>
constexpr auto min(const X &a, const Y &b) {
  return each([](auto x, auto y) { return y < x ? y : x; }, a, b);
}
/// x < y ? y : x
template <typename X, typename Y>
constexpr auto max(const X &a, const Y &b) {
  return each([](auto x, auto y) { return x < y ? y : x; }, a, b);
}
template <typename X, typename Low, typename High>
constexpr auto clamp(const X &x, const Low &low, const High &high) {
  return rtsl::min(rtsl::max(x, low), high);
}

/// x (1 - a) + y a
template <typename X, typename Y, typename A>
constexpr auto mix(const X &x, const Y &y, const A &a) {
  return each([](float p, float q, float t) { return p * (1.0f - t) + q * t; }, x, y, a);
}
/// y where `choice` is true, otherwise x.
template <typename X, typename Y, typename B>
constexpr auto mixSelect(const X &x, const Y &y, const B &choice) {
  return each([](auto p, auto q, auto second) { return second ? q : p; }, x, y, choice);
}
template <typename Edge, typename X>
constexpr auto step(const Edge &edge, const X &x) {
  return each([](float e, float v) { return v < e ? 0.0f : 1.0f; }, edge, x);
}
template <typename Edge, typename X>
constexpr auto smoothstep(const Edge &low, const Edge &high, const X &x) {
  return each(
      [](float e0, float e1, float v) {
        const float t = rtsl::clamp((v - e0) / (e1 - e0), 0.0f, 1.0f);
        return (t * t) * (3.0f - 2.0f * t);
      },
      low, high, x);
}

/// For zero and NaN the number itself.
template <typename T>
constexpr auto sign(const T &value) {
  return each(
      [](auto x) {
        using S = decltype(x);
        return S(0) < x ? S(1) : x < S(0) ? S(-1) : x;
      },
      value);
}

namespace detail {
/// choose(choose(first, second), third), and so on
template <typename T, typename Choose, int... I>
constexpr auto chooseComponent(const T &v, Choose choose, std::integer_sequence<int, I...>) {
  auto result = part<0>(v);
  ((result = choose(result, part<I + 1>(v))), ...);
  return result;
}
} // namespace detail

/// The least component.
template <typename T>
constexpr auto minComponent(const T &v) {
  return detail::chooseComponent(
      v, [](auto a, auto b) { return rtsl::min(a, b); },
      std::make_integer_sequence<int, width<T> - 1>());
}
/// The greatest component.
template <typename T>
constexpr auto maxComponent(const T &v) {
  return detail::chooseComponent(
      v, [](auto a, auto b) { return rtsl::max(a, b); },
      std::make_integer_sequence<int, width<T> - 1>());
}

//===----------------------------------------------------------------------===//
// Comparing
//===----------------------------------------------------------------------===//

template <typename A, typename B>
constexpr auto lessThan(const A &a, const B &b) {
  return each([](auto x, auto y) { return x < y; }, a, b);
}
template <typename A, typename B>
constexpr auto lessThanEqual(const A &a, const B &b) {
  return each([](auto x, auto y) { return x <= y; }, a, b);
}
template <typename A, typename B>
constexpr auto greaterThan(const A &a, const B &b) {
  return each([](auto x, auto y) { return x > y; }, a, b);
}
template <typename A, typename B>
constexpr auto greaterThanEqual(const A &a, const B &b) {
  return each([](auto x, auto y) { return x >= y; }, a, b);
}
template <typename A, typename B>
constexpr auto equal(const A &a, const B &b) {
  return each([](auto x, auto y) { return x == y; }, a, b);
}
template <typename A, typename B>
constexpr auto notEqual(const A &a, const B &b) {
  return each([](auto x, auto y) { return x != y; }, a, b);
}
template <typename T>
constexpr auto logicalNot(const T &a) {
  return each([](bool x) { return !x; }, a);
}
template <typename T>
constexpr bool all(const T &v) {
  bool result = part<0>(v);
  if constexpr (width<T> > 1)
    result = result && part<1>(v);
  if constexpr (width<T> > 2)
    result = result && part<2>(v);
  if constexpr (width<T> > 3)
    result = result && part<3>(v);
  return result;
}
template <typename T>
constexpr bool any(const T &v) {
  return !rtsl::all(rtsl::logicalNot(v));
}
/// low <= x && x <= high in every component.
template <typename T, typename Bound>
constexpr bool inside(const T &x, const Bound &low, const Bound &high) {
  return rtsl::all(rtsl::lessThanEqual(low, x)) && rtsl::all(rtsl::lessThanEqual(x, high));
}

//===----------------------------------------------------------------------===//
// Parts of a number
//===----------------------------------------------------------------------===//

template <typename T>
inline auto abs(const T &value) {
  return each(
      [](auto x) {
        if constexpr (std::is_same_v<decltype(x), float>)
          return std::fabs(x);
        else
          return x < 0 ? static_cast<int>(0u - static_cast<uint>(x)) : x;
      },
      value);
}
template <typename T>
inline auto floor(const T &value) {
  return each([](float x) { return std::floor(x); }, value);
}
template <typename T>
inline auto ceil(const T &value) {
  return each([](float x) { return std::ceil(x); }, value);
}
template <typename T>
inline auto trunc(const T &value) {
  return each([](float x) { return std::trunc(x); }, value);
}
/// To the nearest, halves to even: adding 2^23 rounds off the fraction, subtracting it restores the
/// number.
template <typename T>
inline auto roundEven(const T &value) {
  return each(
      [](float x) {
        const float magnitude = std::fabs(x);
        const float rounded = (magnitude + 8388608.0f) - 8388608.0f;
        return magnitude < 8388608.0f ? std::copysign(rounded, x) : x;
      },
      value);
}
template <typename T>
inline auto round(const T &value) {
  return rtsl::roundEven(value);
}
template <typename T>
inline auto fract(const T &value) {
  return each([](float x) { return x - std::floor(x); }, value);
}
template <typename X, typename Y>
inline auto mod(const X &value, const Y &divisor) {
  return each([](float x, float y) { return x - y * std::floor(x / y); }, value, divisor);
}
/// Both parts have the sign of x; the fraction of an infinity is 0. `whole` may be the variable
/// that is the argument.
template <typename T>
inline T modf(T value, T &whole) {
  whole = rtsl::trunc(value);
  return each([](float x, float w) { return std::copysign(x == w ? 0.0f : x - w, x); }, value,
              whole);
}
template <typename T>
inline auto isnan(const T &value) {
  return each([](float x) { return x != x; }, value);
}
template <typename T>
inline auto isinf(const T &value) {
  return each([](float x) { return std::fabs(x) == infinity; }, value);
}
template <typename A, typename B, typename C>
inline auto fma(const A &a, const B &b, const C &c) {
  return each([](float x, float y, float z) { return std::fma(x, y, z); }, a, b, c);
}

/// All NaNs have the same bits.
template <typename T>
inline auto floatBitsToInt(const T &value) {
  return each([](float x) { return x != x ? 0x7fc00000 : bitsAs<int>(x); }, value);
}
template <typename T>
inline auto floatBitsToUint(const T &value) {
  return each([](float x) { return x != x ? 0x7fc00000u : bitsAs<uint>(x); }, value);
}
template <typename T>
inline auto intBitsToFloat(const T &value) {
  return each([](int x) { return bitsAs<float>(x); }, value);
}
template <typename T>
inline auto uintBitsToFloat(const T &value) {
  return each([](uint x) { return bitsAs<float>(x); }, value);
}

/// x = significand * 2^exponent with the significand in [0.5, 1). Zero, infinities and NaN have
/// exponent 0.
inline float frexp(float x, int &exponent) {
  exponent = 0;
  const float magnitude = std::fabs(x);
  if (!(magnitude > 0.0f && magnitude < infinity))
    return x;
  const bool isSmall = magnitude < 0x1p-126f; // a subnormal becomes normal by an exact factor
  const uint bits = bitsAs<uint>(isSmall ? x * 0x1p24f : x);
  exponent = static_cast<int>(bits >> 23 & 0xffu) - 126 - (isSmall ? 24 : 0);
  return bitsAs<float>((bits & 0x807fffffu) | 0x3f000000u);
}
template <int L>
inline glm::vec<L, float> frexp(const glm::vec<L, float> &x, glm::vec<L, int> &exponent) {
  glm::vec<L, float> significand;
  for (int i = 0; i < L; ++i)
    significand[i] = rtsl::frexp(x[i], exponent[i]);
  return significand;
}

/// x * 2^exponent, rounded once: factors above 1 are exact, and if a step below 2^-126 rounds, the
/// following ones make the result zero.
template <typename T, typename E>
inline auto ldexp(const T &value, const E &exponents) {
  return each(
      [](float x, int exponent) {
        int rest = rtsl::clamp(exponent, -280, 280);
        for (int i = 0; i < 3; ++i) {
          const int step = i == 2 ? rest : rest < -126 ? -102 : rtsl::min(rest, 127);
          x = x * bitsAs<float>(static_cast<uint>(step + 127) << 23);
          rest -= step;
        }
        return x;
      },
      value, exponents);
}

} // namespace RTSL_VARIANT
} // namespace rtsl
