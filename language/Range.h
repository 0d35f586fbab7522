//===- Range.h - which values a member may have ---------------------------===//
//
// `public float roughness in [0, 1];` The checker applies it to defaults, the runtime to all other
// values.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <charconv>
#include <cmath>
#include <limits>
#include <string>

namespace rtsl {

/// An interval. Infinity and NaN are in none: infinite bounds are excluded.
struct Range {
  static constexpr double unbounded = std::numeric_limits<double>::infinity();

  double low = -unbounded, high = unbounded;
  bool includesLow = false, includesHigh = false;

  bool contains(double value) const {
    return (includesLow ? low <= value : low < value) &&
           (includesHigh ? value <= high : value < high);
  }
  bool isEmpty() const { return includesLow && includesHigh ? !(low <= high) : !(low < high); }
};

/// The shortest number that gives this float; an integer is written as one.
inline std::string numberText(double value) {
  char text[32] = "";
  const bool isInteger = value == std::floor(value) && std::abs(value) < 1e10;
  const auto end = isInteger
                       ? std::to_chars(text, text + sizeof text, static_cast<long long>(value))
                       : std::to_chars(text, text + sizeof text, static_cast<float>(value));
  return std::string(text, end.ptr);
}

/// As it is written in RTSL: "(0, inf)".
inline std::string toString(const Range &range) {
  return (range.includesLow ? "[" : "(") + numberText(range.low) + ", " + numberText(range.high) +
         (range.includesHigh ? "]" : ")");
}

} // namespace rtsl
