//===- Integers.h - arithmetic that is always defined ---------------------===//
//
// An int wraps like a uint. x / 0 and x % 0 are 0, INT_MIN / -1 is INT_MIN. Only the lowest five
// bits of a shift count are used.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "rtsl/shader/Common.h"

namespace rtsl {
inline namespace RTSL_VARIANT {

namespace detail {
constexpr int wrap(uint x) {
  return static_cast<int>(x);
}
constexpr uint unwrap(int x) {
  return static_cast<uint>(x);
}
} // namespace detail

template <typename A, typename B>
constexpr auto add(const A &a, const B &b) {
  return each([](int x, int y) { return detail::wrap(detail::unwrap(x) + detail::unwrap(y)); }, a,
              b);
}
template <typename A, typename B>
constexpr auto subtract(const A &a, const B &b) {
  return each([](int x, int y) { return detail::wrap(detail::unwrap(x) - detail::unwrap(y)); }, a,
              b);
}
template <typename A, typename B>
constexpr auto multiply(const A &a, const B &b) {
  return each([](int x, int y) { return detail::wrap(detail::unwrap(x) * detail::unwrap(y)); }, a,
              b);
}
/// From left to right.
template <typename A, typename B, typename... C>
constexpr auto add(const A &a, const B &b, const C &...more) {
  return rtsl::add(rtsl::add(a, b), more...);
}
template <typename A, typename B, typename... C>
constexpr auto multiply(const A &a, const B &b, const C &...more) {
  return rtsl::multiply(rtsl::multiply(a, b), more...);
}
template <typename T>
constexpr auto negate(const T &a) {
  return each(
      [](auto x) {
        if constexpr (std::is_same_v<decltype(x), int>)
          return detail::wrap(0u - detail::unwrap(x));
        else
          return -x;
      },
      a);
}
/// By component: GLM subtracts from 0, which does not negate zeros.
template <int C, int R>
inline glm::mat<C, R, float> negate(const glm::mat<C, R, float> &a) {
  glm::mat<C, R, float> result;
  for (int column = 0; column < C; ++column)
    result[column] = rtsl::negate(a[column]);
  return result;
}

template <typename A, typename B>
constexpr auto divide(const A &a, const B &b) {
  return each(
      [](auto x, auto y) {
        using S = decltype(x);
        if (y == 0)
          return S(0);
        if constexpr (std::is_signed_v<S>)
          if (y == -1)
            return detail::wrap(0u - detail::unwrap(x));
        return S(x / y);
      },
      a, b);
}
template <typename A, typename B>
constexpr auto remainder(const A &a, const B &b) {
  return each(
      [](auto x, auto y) {
        using S = decltype(x);
        if (y == 0)
          return S(0);
        if constexpr (std::is_signed_v<S>)
          if (y == -1)
            return S(0);
        return S(x % y);
      },
      a, b);
}
template <typename A, typename B>
constexpr auto shiftLeft(const A &a, const B &count) {
  return each(
      [](auto x, auto n) {
        return static_cast<decltype(x)>(static_cast<uint>(x) << (static_cast<uint>(n) & 31u));
      },
      a, count);
}
/// Keeps the sign of an int.
template <typename A, typename B>
constexpr auto shiftRight(const A &a, const B &count) {
  return each(
      [](auto x, auto n) { return static_cast<decltype(x)>(x >> (static_cast<uint>(n) & 31u)); }, a,
      count);
}

/// ++x and --x, x++ and x--.
template <typename T>
constexpr T &increment(T &x) {
  if constexpr (std::is_same_v<Scalar<T>, int>)
    return x = rtsl::add(x, 1);
  else
    return ++x;
}
template <typename T>
constexpr T &decrement(T &x) {
  if constexpr (std::is_same_v<Scalar<T>, int>)
    return x = rtsl::subtract(x, 1);
  else
    return --x;
}
template <typename T>
constexpr T postIncrement(T &x) {
  const T before = x;
  increment(x);
  return before;
}
template <typename T>
constexpr T postDecrement(T &x) {
  const T before = x;
  decrement(x);
  return before;
}

//===----------------------------------------------------------------------===//
// With carry
//===----------------------------------------------------------------------===//

template <typename T>
inline T uaddCarry(const T &a, const T &b, T &carry) {
  const T sum = a + b;
  carry = each([](uint s, uint x) { return s < x ? 1u : 0u; }, sum, a);
  return sum;
}
template <typename T>
inline T usubBorrow(const T &a, const T &b, T &borrow) {
  const T difference = a - b;
  borrow = each([](uint x, uint y) { return x < y ? 1u : 0u; }, a, b);
  return difference;
}
template <typename T>
inline void umulExtended(const T &a, const T &b, T &high, T &low) {
  const T top =
      each([](uint x, uint y) { return static_cast<uint>(std::uint64_t(x) * y >> 32); }, a, b);
  const T bottom = each([](uint x, uint y) { return x * y; }, a, b);
  high = top;
  low = bottom;
}
template <typename T>
inline void imulExtended(const T &a, const T &b, T &high, T &low) {
  const T top =
      each([](int x, int y) { return static_cast<int>(std::int64_t(x) * y >> 32); }, a, b);
  const T bottom = rtsl::multiply(a, b);
  high = top;
  low = bottom;
}

//===----------------------------------------------------------------------===//
// Bits
//===----------------------------------------------------------------------===//

namespace detail {
constexpr int countBits(uint x) {
  x = x - ((x >> 1) & 0x55555555u);
  x = (x & 0x33333333u) + ((x >> 2) & 0x33333333u);
  x = (x + (x >> 4)) & 0x0f0f0f0fu;
  return static_cast<int>((x * 0x01010101u) >> 24);
}
} // namespace detail

template <typename T>
constexpr auto bitCount(const T &value) {
  return each([](auto x) { return detail::countBits(static_cast<uint>(x)); }, value);
}
template <typename T>
constexpr auto bitfieldReverse(const T &value) {
  return each(
      [](auto from) {
        auto x = static_cast<uint>(from);
        x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
        x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
        x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
        x = ((x >> 8) & 0x00ff00ffu) | ((x & 0x00ff00ffu) << 8);
        return static_cast<decltype(from)>(x >> 16 | x << 16);
      },
      value);
}
/// The position of the lowest set bit; -1 for 0.
template <typename T>
constexpr auto findLSB(const T &value) {
  return each(
      [](auto from) {
        const auto x = static_cast<uint>(from);
        return x == 0 ? -1 : detail::countBits((x & (0u - x)) - 1u);
      },
      value);
}
/// The position of the highest set bit, or, for a negative int, of the highest clear bit; -1 for 0
/// and -1.
template <typename T>
constexpr auto findMSB(const T &value) {
  return each(
      [](auto from) {
        auto x = static_cast<uint>(from);
        if constexpr (std::is_signed_v<decltype(from)>)
          x = from < 0 ? ~x : x;
        for (uint distance = 1; distance < 32; distance *= 2)
          x |= x >> distance;
        return detail::countBits(x) - 1;
      },
      value);
}
/// Counts are taken modulo 32, where GLSL leaves the result undefined (`bits` of 32 is 32).
template <typename T>
constexpr auto bitfieldExtract(const T &value, int offset, int bits) {
  return each(
      [](auto x, int at, int count) {
        using S = decltype(x);
        const uint from = detail::unwrap(at), wanted = detail::unwrap(count);
        const uint unused = (32u - wanted) & 31u;
        if (count == 0)
          return S(0);
        if constexpr (std::is_signed_v<S>)
          return S(S(detail::unwrap(x) << ((32u - wanted - from) & 31u)) >> unused);
        else
          return S((x >> (from & 31u)) & (~0u >> unused));
      },
      value, offset, bits);
}
template <typename T>
constexpr auto bitfieldInsert(const T &base, const T &insert, int offset, int bits) {
  return each(
      [](auto x, auto y, int at, int count) {
        const uint from = detail::unwrap(at) & 31u;
        const uint low = count == 0 ? 0u : ~0u >> ((32u - detail::unwrap(count)) & 31u);
        const uint mask = low << from;
        return static_cast<decltype(x)>((static_cast<uint>(x) & ~mask) |
                                        ((static_cast<uint>(y) << from) & mask));
      },
      base, insert, offset, bits);
}

} // namespace RTSL_VARIANT
} // namespace rtsl
