//===- Packing.h - vectors in a word, half floats -------------------------===//
//
// Component 0 lies in the lowest bits. Halves are converted in integers, so that every target and
// the printed C++ give the same bits, NaN included.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "language/formulas/Common.h"

namespace rtsl::formulas {

template <typename Number>
Number combine(Number components, unsigned bits) {
  auto mask = static_cast<std::int64_t>((1u << bits) - 1);
  Number word = components[0] & mask;
  for (unsigned i = 1; i < components.count(); ++i)
    word = word | shiftLeft(components[i] & mask, static_cast<int>(i * bits));
  return word;
}

template <typename Number>
Number separate(Number word, unsigned bits, unsigned count) {
  auto mask = static_cast<std::int64_t>((1u << bits) - 1);
  std::vector<Number> components;
  for (unsigned i = 0; i < count; ++i)
    components.push_back(shiftRight(word, static_cast<int>(i * bits)) & mask);
  return Number::vector(components);
}

/// NaN becomes the lower bound: max(low, x) keeps its first operand unless it is less.
template <typename Number>
Number quantise(Number x, double low, double scale) {
  Number clamped = minimum(maximum(x.like(low), x), x.like(1));
  return toInt(roundEven(clamped * scale));
}

template <typename Number>
Number signExtended(Number integers, int bits) {
  return shiftRightSigned(shiftLeft(integers, 32 - bits), 32 - bits);
}

template <typename Number>
Number snorm(Number integers, double scale) {
  Number x = toFloat(integers) / scale;
  return clamp(x, x.like(-1), x.like(1));
}

/// f32 -> the 16 bits of a half in an int, rounded to nearest, ties to even.
template <typename Number>
Number halfFromFloat(Number x) {
  return outline(
      "halfFromFloat",
      [](Number x) {
        Number bits = x.bits();
        Number sign = shiftRight(bits, 16) & 0x8000;
        Number magnitude = bits & 0x7fffffff;
        // Normal halves: 13 bits go, the exponent's bias falls by 112. A carry may reach the
        // exponent, up to infinity.
        Number isOdd = shiftRight(magnitude, 13) & 1;
        Number normal = shiftRight(magnitude - 0x38000000 + 0xfff + isOdd, 13);
        // Subnormal halves are multiples of 2^-24, the distance of floats just above 0.5.
        Number subnormal = (magnitude.asFloat() + 0.5).bits() - 0x3f000000;
        Number half = select(less(magnitude, 0x38800000), subnormal, normal);
        half = select(less(0x477fffff, magnitude), 0x7c00, half);        // 65536 and more
        return select(less(0x7f800000, magnitude), 0x7e00, sign | half); // of a NaN no sign is seen
      },
      x);
}

template <typename Number>
Number floatFromHalf(Number bits) {
  return outline(
      "floatFromHalf",
      [](Number bits) {
        Number magnitude = bits & 0x7fff;
        Number normal = shiftLeft(magnitude, 13) + 0x38000000;
        // Read as a significand after an exponent of 2^-14, then the leading one is taken away:
        // exact.
        Number subnormal = ((shiftLeft(magnitude, 13) + 0x38800000).asFloat() - 0x1p-14).bits();
        Number value = select(less(magnitude, 0x400), subnormal, normal);
        value = select(less(0x7bff, magnitude), normal + 0x38000000, value); // infinity and NaN
        return (value | shiftLeft(bits & 0x8000, 16)).asFloat();
      },
      bits);
}

template <typename Number>
Number packUnorm2x16(Number v) {
  return combine(quantise(v, 0, 65535), 16);
}
template <typename Number>
Number packSnorm2x16(Number v) {
  return combine(quantise(v, -1, 32767), 16);
}
template <typename Number>
Number packUnorm4x8(Number v) {
  return combine(quantise(v, 0, 255), 8);
}
template <typename Number>
Number packSnorm4x8(Number v) {
  return combine(quantise(v, -1, 127), 8);
}
template <typename Number>
Number packHalf2x16(Number v) {
  return combine(halfFromFloat(v), 16);
}
template <typename Number>
Number unpackUnorm2x16(Number word) {
  return toFloat(separate(word, 16, 2)) / 65535.0;
}
template <typename Number>
Number unpackSnorm2x16(Number word) {
  return snorm(signExtended(separate(word, 16, 2), 16), 32767);
}
template <typename Number>
Number unpackUnorm4x8(Number word) {
  return toFloat(separate(word, 8, 4)) / 255.0;
}
template <typename Number>
Number unpackSnorm4x8(Number word) {
  return snorm(signExtended(separate(word, 8, 4), 8), 127);
}
template <typename Number>
Number unpackHalf2x16(Number word) {
  return floatFromHalf(separate(word, 16, 2));
}

} // namespace rtsl::formulas
