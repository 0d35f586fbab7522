// log, log2 and log1p.
#pragma once

#include "runtime/device/math/LogarithmKernel.h"
#include "runtime/device/math/Rounding.h"

namespace rtsl::device {

/// Natural logarithm. -infinity at both zeros, NaN below.
inline float log(float x) {
  using namespace detail;
  if (x == 0.0f)
    return -infinity();
  if (!(x > 0.0f))
    return canonicalNaN();
  if (x == infinity())
    return x;
  Double2 y = naturalLogarithm({x, 0.0});
  return roundToFloat(y);
}

/// Logarithm to base 2. Exact for powers of two.
inline float log2(float x) {
  using namespace detail;
  if (x == 0.0f)
    return -infinity();
  if (!(x > 0.0f))
    return canonicalNaN();
  if (x == infinity())
    return x;
  Double2 y = binaryLogarithm(x);
  return roundToFloat(y);
}

/// ln(1 + x), accurate near zero. -infinity at -1, NaN below.
inline float log1p(float x) {
  using namespace detail;
  if (x == -1.0f)
    return -infinity();
  if (!(x > -1.0f))
    return canonicalNaN();
  if (x == infinity() || x == 0.0f)
    return x;
  Double2 y = naturalLogarithmOfOnePlus({x, 0.0});
  return roundToFloat(y);
}

} // namespace rtsl::device
