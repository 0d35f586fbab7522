// Sines and cosines of small angles in plain double.
#pragma once

#include "math/kernels/Bits.h"

namespace rtsl::device::detail {

/// sin(r) for |r| <= pi/4, by Taylor's series up to r^15/15!; what is left out is below 2^-53 |r|.
inline double plainSine(double r) {
  double z = r * r, z2 = z * z;
  double q0 = fma(z, 1.0 / 120, -1.0 / 6), q1 = fma(z, 1.0 / 362880, -1.0 / 5040);
  double q2 = fma(z, 1.0 / 6227020800, -1.0 / 39916800);
  double q = fma(z2, fma(z2, fma(z2, -1.0 / 1307674368000, q2), q1), q0);
  return fma(r * z, q, r);
}

/// cos(r) for |r| <= pi/4, by Taylor's series up to r^14/14!; what is left out is below 2^-49.
inline double plainCosine(double r) {
  double z = r * r, z2 = z * z;
  double q0 = fma(z, 1.0 / 24, -0.5), q1 = fma(z, 1.0 / 40320, -1.0 / 720);
  double q2 = fma(z, 1.0 / 479001600, -1.0 / 3628800);
  double q = fma(z2, fma(z2, fma(z2, -1.0 / 87178291200, q2), q1), q0);
  return fma(z, q, 1.0);
}

} // namespace rtsl::device::detail
