// Which arguments are tested.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace rtsl::elementary {

inline float floatOf(std::uint32_t bits) {
  return __builtin_bit_cast(float, bits);
}
inline std::uint32_t bitsOf(float x) {
  return __builtin_bit_cast(std::uint32_t, x);
}

/// Zeros, infinities, NaNs, every power of two and the places where the functions change their
/// method, all with their neighbours and in both signs.
const std::vector<float> &specialArguments();

/// Arguments of a function of one argument whose results lie closest to a midpoint between floats,
/// among all 2^32: where a wrong rounding is most likely.
const std::vector<float> &hardArguments(std::string_view function);

struct Pair {
  float first, second;
};

/// Pair number `index` for pow or atan2, the same on every run: random bits, usual arguments, exact
/// cases, results near 1, near the ends of the range, and results within 2^-48 and less of a
/// midpoint between floats.
Pair argumentPair(std::string_view function, std::uint64_t index);

} // namespace rtsl::elementary
