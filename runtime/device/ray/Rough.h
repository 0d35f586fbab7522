//===- Rough.h - quotients and roots that need few digits -----------------===//
//
// For bounds of errors, and for tests of boxes that are enlarged by more than what is wrong here.
// With --fp=fast a GPU computes them by its approximations, which take a quarter of the
// instructions: within 2 units in the last place, for numbers from 2^-126 to 2^126 ("rcp" and
// "sqrt" in the manual of PTX). Otherwise they are rounded to the nearest float.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/ray/Abi.h"
#include "runtime/device/ray/Vector.h"

namespace rtsl::device {

/// 1 / a. With an approximation infinite if a is 0 or denormal, and 0 if |a| is above 2^126.
inline float roughReciprocal(float a) {
#ifdef __NVPTX__
  if (rtsl_is_fast())
    return __nvvm_rcp_approx_ftz_f(a);
#endif
  return 1.0f / a;
}

inline float roughQuotient(float a, float b) {
#ifdef __NVPTX__
  if (rtsl_is_fast())
    return a * roughReciprocal(b);
#endif
  return a / b;
}

inline float roughRoot(float a) {
#ifdef __NVPTX__
  if (rtsl_is_fast())
    return __nvvm_sqrt_approx_ftz_f(a);
#endif
  return squareRoot(a);
}

} // namespace rtsl::device
