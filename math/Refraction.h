// refract(i, n, eta): GLSL's formula without its cancellations.
//
//     d = n . i,  k = 1 - eta^2 (1 - d^2),  eta i - (eta d + sqrt(k)) n, and 0 where k < 0
//
// Near the angle of total reflection k is a small difference, and the error of its root is the root
// of its error: computed in single precision, directions were wrong by thousands of rounding units
// there. So everything is computed in double and rounded once at the end; if double cannot decide
// whether k is negative, k is computed again in double-double.
#pragma once

#include "math/kernels/DoubleDouble.h"

namespace rtsl::device {

namespace detail {

/// k to about 2^-100, for vectors whose lengths are near 1.
template <int count, typename T>
[[gnu::cold, gnu::pure, gnu::noinline]] inline double carefulRadicand(const T *i, const T *n,
                                                                      T eta) {
  constexpr Double2 one = {1.0, 0.0};
  Double2 d = twoProduct(double(n[0]), double(i[0]));
  for (int c = 1; c < count; ++c)
    d = add(d, twoProduct(double(n[c]), double(i[c])));
  Double2 sineSquared = add(one, negate(multiply(d, d)));
  Double2 k = add(one, negate(multiply(twoProduct(double(eta), double(eta)), sineSquared)));
  return k.hi;
}

/// Where plain double computes a k of this size or less, relative to its largest term, it computes
/// k again: its own error is below 2^-48, and the root of a larger k is good to 2^-29.
inline constexpr double smallRadicand = 0x1p-40;

} // namespace detail

/// The refracted direction, each component within a rounding unit of max(1, |eta|) for i and n of
/// unit length, up to rounding; 0 for total reflection, which is decided for the given i, n and
/// eta, without rounding.
template <int count, typename T>
inline void refract(const T *i, const T *n, T eta, T *refracted) {
  using namespace detail;
  double d = double(n[0]) * double(i[0]);
  for (int c = 1; c < count; ++c)
    d += double(n[c]) * double(i[c]);
  double etaSquared = double(eta) * double(eta);
  double k = fma(-etaSquared, fma(-d, d, 1.0), 1.0);
  if (!(absolute(k) > smallRadicand * (1.0 + etaSquared)))
    k = carefulRadicand<count>(i, n, eta);
  double along = fma(double(eta), d, squareRoot(k)); // a NaN if k < 0
  for (int c = 0; c < count; ++c)
    refracted[c] = k < 0.0 ? T(0) : T(fma(double(eta), double(i[c]), -(along * double(n[c]))));
}

} // namespace rtsl::device
