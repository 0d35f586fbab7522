//===- Packing.h - several small numbers in one word ----------------------===//
//
// Component 0 is in the lowest bits. Halves are converted with integer operations, so that every
// target gives the same bits, NaN included.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "rtsl/shader/Integers.h"

namespace rtsl {
inline namespace RTSL_VARIANT {

namespace detail {

/// `bits` bits of each component.
template <int L>
inline uint combine(const glm::vec<L, int> &components, int bits) {
  const uint mask = (1u << bits) - 1u;
  uint word = 0;
  for (int i = 0; i < L; ++i)
    word |= (unwrap(components[i]) & mask) << (i * bits);
  return word;
}
template <int L>
inline glm::vec<L, int> separate(uint word, int bits, bool isSigned) {
  glm::vec<L, int> components;
  for (int i = 0; i < L; ++i) {
    const uint top = word << (32 - bits - i * bits);
    components[i] = isSigned ? wrap(top) >> (32 - bits) : wrap(top >> (32 - bits));
  }
  return components;
}
/// NaN becomes the lower bound.
template <typename T>
inline auto quantise(const T &x, float low, float scale) {
  return rtsl::toInt(rtsl::roundEven(rtsl::min(rtsl::max(T(low), x), T(1.0f)) * scale));
}

inline int halfFromFloat(float x) {
  const uint bits = bitsAs<uint>(x);
  const uint sign = bits >> 16 & 0x8000u;
  const uint magnitude = bits & 0x7fffffffu;
  if (magnitude > 0x7f800000u) // the sign of a NaN is not kept
    return 0x7e00;
  if (magnitude > 0x477fffffu) // 65536 and more
    return wrap(sign | 0x7c00u);
  if (magnitude < 0x38800000u) // multiples of 2^-24, the distance of floats just above 0.5
    return wrap(sign | (bitsAs<uint>(bitsAs<float>(magnitude) + 0.5f) - 0x3f000000u));
  // 13 bits are dropped, the exponent's bias is reduced by 112. A carry may reach the exponent, up
  // to infinity.
  return wrap(sign | (magnitude - 0x38000000u + 0xfffu + (magnitude >> 13 & 1u)) >> 13);
}
inline float floatFromHalf(int half) {
  const uint bits = unwrap(half);
  const uint magnitude = bits & 0x7fffu;
  uint value = (magnitude << 13) + 0x38000000u;
  if (magnitude < 0x400u) // read with the exponent 2^-14, then the leading one is subtracted: exact
    value = bitsAs<uint>(bitsAs<float>((magnitude << 13) + 0x38800000u) - 0x1p-14f);
  else if (magnitude > 0x7bffu) // infinity and NaN
    value += 0x38000000u;
  return bitsAs<float>(value | (bits & 0x8000u) << 16);
}

} // namespace detail

inline uint packUnorm2x16(const glm::vec2 &v) {
  return detail::combine<2>(detail::quantise(v, 0.0f, 65535.0f), 16);
}
inline uint packSnorm2x16(const glm::vec2 &v) {
  return detail::combine<2>(detail::quantise(v, -1.0f, 32767.0f), 16);
}
inline uint packUnorm4x8(const glm::vec4 &v) {
  return detail::combine<4>(detail::quantise(v, 0.0f, 255.0f), 8);
}
inline uint packSnorm4x8(const glm::vec4 &v) {
  return detail::combine<4>(detail::quantise(v, -1.0f, 127.0f), 8);
}
inline uint packHalf2x16(const glm::vec2 &v) {
  return detail::combine<2>({detail::halfFromFloat(v.x), detail::halfFromFloat(v.y)}, 16);
}
inline glm::vec2 unpackUnorm2x16(uint word) {
  return glm::vec2(detail::separate<2>(word, 16, false)) / 65535.0f;
}
inline glm::vec2 unpackSnorm2x16(uint word) {
  return rtsl::clamp(glm::vec2(detail::separate<2>(word, 16, true)) / 32767.0f, -1.0f, 1.0f);
}
inline glm::vec4 unpackUnorm4x8(uint word) {
  return glm::vec4(detail::separate<4>(word, 8, false)) / 255.0f;
}
inline glm::vec4 unpackSnorm4x8(uint word) {
  return rtsl::clamp(glm::vec4(detail::separate<4>(word, 8, true)) / 127.0f, -1.0f, 1.0f);
}
inline glm::vec2 unpackHalf2x16(uint word) {
  const glm::ivec2 halves = detail::separate<2>(word, 16, false);
  return {detail::floatFromHalf(halves.x), detail::floatFromHalf(halves.y)};
}

} // namespace RTSL_VARIANT
} // namespace rtsl
