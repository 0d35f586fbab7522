//===- Numbers.h - numbers made from other numbers ------------------------===//
#pragma once

#include <cstdint>
#include <cstring>
#include <string>

namespace rtsl::random {

/// A hash of two numbers.
inline std::uint32_t mix(std::uint32_t a, std::uint32_t b) {
  std::uint32_t h = (a ^ b) * 0x9e3779b1u;
  h = (h ^ h >> 15) * 0x85ebca6bu;
  return h ^ h >> 13;
}

inline std::uint32_t hashOf(const std::string &text) {
  std::uint32_t h = 2166136261u;
  for (char c : text)
    h = (h ^ static_cast<unsigned char>(c)) * 16777619u;
  return h;
}

inline std::uint32_t bitsOf(float value) {
  std::uint32_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

/// The bits of a float, often of an extreme one.
std::uint32_t someFloat(std::uint32_t key);

} // namespace rtsl::random
