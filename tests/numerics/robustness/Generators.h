//===- Generators.h - random inputs, the same on every machine ------------===//
#pragma once

#include "runtime/device/ray/Vector.h"

#include <cstdint>
#include <string>

namespace rtsl::numerics {

/// SplitMix64 (G. Steele, D. Lea, C. Flood, "Fast Splittable Pseudorandom Number Generators",
/// 2014). The distributions of the standard library differ from one implementation to the next.
class Random {
public:
  explicit Random(std::uint64_t seed) : state(seed) {}

  std::uint64_t bits() {
    std::uint64_t z = state += 0x9E3779B97F4A7C15u;
    z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9u;
    z = (z ^ z >> 27) * 0x94D049BB133111EBu;
    return z ^ z >> 31;
  }
  std::uint64_t index(std::uint64_t count) { return bits() % count; }
  int integer(int low, int high) { return low + int(index(std::uint64_t(high - low) + 1)); }
  float between(float low, float high) {
    return low + (high - low) * (float(bits() >> 40) * 0x1p-24f);
  }
  /// Uniform in [-size, size] each.
  device::Vec3 inBox(float size) {
    const float x = between(-size, size), y = between(-size, size), z = between(-size, size);
    return {x, y, z};
  }
  /// Of length 1, every direction alike.
  device::Vec3 direction() {
    for (;;) {
      const device::Vec3 v = inBox(1);
      const float square = device::dot(v, v);
      if (square > 0.01f && square < 1)
        return device::normalized(v);
    }
  }

private:
  std::uint64_t state;
};

/// "(x, y, z)" with hexadecimal floats, which read back the same.
std::string show(device::Vec3 v);

struct Ray {
  device::Vec3 origin, direction;

  std::string text() const { return "origin " + show(origin) + ", direction " + show(direction); }
};

} // namespace rtsl::numerics
