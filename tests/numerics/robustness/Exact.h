//===- Exact.h - arithmetic without rounding ------------------------------===//
#pragma once

#include "runtime/device/ray/Vector.h"

#include <boost/multiprecision/cpp_int.hpp>

#include <array>
#include <cmath>

namespace rtsl::numerics {

using Rational = boost::multiprecision::cpp_rational;

/// A finite float as it is.
inline Rational exact(float value) {
  int exponent = 0;
  const auto mantissa = static_cast<long>(std::frexp(value, &exponent) * 0x1p24f);
  exponent -= 24;
  Rational result = mantissa;
  const boost::multiprecision::cpp_int power = boost::multiprecision::cpp_int(1)
                                               << (exponent < 0 ? -exponent : exponent);
  return exponent < 0 ? result / Rational(power) : result * Rational(power);
}

struct ExactVec3 {
  std::array<Rational, 3> c;

  ExactVec3(Rational x, Rational y, Rational z) : c{std::move(x), std::move(y), std::move(z)} {}
  explicit ExactVec3(device::Vec3 v) : c{exact(v.x), exact(v.y), exact(v.z)} {}
  const Rational &operator[](int i) const { return c[i]; }
};

inline ExactVec3 operator-(const ExactVec3 &a, const ExactVec3 &b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Rational dot(const ExactVec3 &a, const ExactVec3 &b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline ExactVec3 cross(const ExactVec3 &a, const ExactVec3 &b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Where a line meets the plane of a triangle, and with which weights. The determinant is 0 for a
/// line in the plane or a triangle without area; then nothing else is set.
struct ExactHit {
  Rational determinant, t, u, v;

  /// The smallest of the three weights: negative outside, 0 on an edge.
  Rational smallestWeight() const;
};
ExactHit intersectExactly(device::Vec3 origin, device::Vec3 direction, device::Vec3 v0,
                          device::Vec3 v1, device::Vec3 v2);

} // namespace rtsl::numerics
