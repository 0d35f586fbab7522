//===- HighPrecision.h - numbers of 100 digits, by MPFR -------------------===//
#pragma once

#include "runtime/device/ray/Vector.h"

#include <boost/multiprecision/mpfr.hpp>

#include <array>
#include <cmath>

namespace rtsl::numerics {

/// 332 bits: sums and products of floats such as the rows have are exact, roots and exponentials as
/// good as.
using Precise = boost::multiprecision::number<boost::multiprecision::mpfr_float_backend<100>,
                                              boost::multiprecision::et_off>;

using PreciseVec3 = std::array<Precise, 3>;

inline PreciseVec3 precise(device::Vec3 v) {
  return {Precise(v.x), Precise(v.y), Precise(v.z)};
}
inline PreciseVec3 operator-(const PreciseVec3 &a, const PreciseVec3 &b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline PreciseVec3 along(const PreciseVec3 &a, const Precise &t, const PreciseVec3 &d) {
  return {a[0] + t * d[0], a[1] + t * d[1], a[2] + t * d[2]};
}
inline Precise dot(const PreciseVec3 &a, const PreciseVec3 &b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Precise length(const PreciseVec3 &a) {
  return sqrt(dot(a, a));
}

/// |value - exact| in rounding units of `exact`, 2^-24 of it; subnormal results may be off by half
/// of the smallest float.
inline double roundingUnits(float value, const Precise &exact) {
  if (!std::isfinite(value))
    return std::numeric_limits<double>::infinity();
  const Precise error = abs(Precise(value) - exact) - Precise(0x1p-150);
  const Precise unit = abs(exact) * Precise(0x1p-24);
  if (error <= 0)
    return 0;
  return static_cast<double>(unit == 0 ? Precise(error / Precise(0x1p-150))
                                       : Precise(error / (unit + Precise(0x1p-150))));
}

} // namespace rtsl::numerics
