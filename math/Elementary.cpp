// The elementary functions and `refract` under C names, for compiled shaders to call. LLVM does not
// see through all that they call that they depend on their arguments alone; so they say so.
#include "math/Elementary.h"
#include "math/Refraction.h"

#if defined(__AVX2__) && defined(__FMA__)
#include "math/PowerLanes.h"
#endif

#define RTSL_EXPORT_UNARY(name)                                                                    \
  [[gnu::const]] float rtsl_##name(float x) {                                                      \
    return rtsl::device::name(x);                                                                  \
  }
/// For vectors with that number of components.
#define RTSL_EXPORT_REFRACT(count)                                                                 \
  void rtsl_refract##count(const float *incident, const float *normal, float eta,                  \
                           float *refracted) {                                                     \
    rtsl::device::refract<count>(incident, normal, eta, refracted);                                \
  }
#define RTSL_EXPORT_BINARY(name)                                                                   \
  [[gnu::const]] float rtsl_##name(float x, float y) {                                             \
    return rtsl::device::name(x, y);                                                               \
  }

/// Code that needs the sine and the cosine of an angle calls this twice, which the optimiser merges
/// into one call.
[[gnu::const, gnu::noinline]] static rtsl::device::SineAndCosine sineAndCosine(float x) {
  return rtsl::device::sineAndCosine(x);
}
[[gnu::const, gnu::noinline]] static rtsl::device::SineAndCosine sineAndCosineOfPi(float x) {
  return rtsl::device::sineAndCosineOfPi(x);
}

extern "C" {

float rtsl_sin(float x) {
  return sineAndCosine(x).sine;
}
float rtsl_cos(float x) {
  return sineAndCosine(x).cosine;
}
float rtsl_sinpi(float x) {
  return sineAndCosineOfPi(x).sine;
}
float rtsl_cospi(float x) {
  return sineAndCosineOfPi(x).cosine;
}
RTSL_EXPORT_UNARY(tan)
RTSL_EXPORT_UNARY(asin)
RTSL_EXPORT_UNARY(acos)
RTSL_EXPORT_UNARY(atan)
RTSL_EXPORT_UNARY(sinh)
RTSL_EXPORT_UNARY(cosh)
RTSL_EXPORT_UNARY(tanh)
RTSL_EXPORT_UNARY(asinh)
RTSL_EXPORT_UNARY(acosh)
RTSL_EXPORT_UNARY(atanh)
RTSL_EXPORT_UNARY(exp)
RTSL_EXPORT_UNARY(exp2)
RTSL_EXPORT_UNARY(expm1)
RTSL_EXPORT_UNARY(log)
RTSL_EXPORT_UNARY(log2)
RTSL_EXPORT_UNARY(log1p)
RTSL_EXPORT_UNARY(sqrt)
RTSL_EXPORT_UNARY(inversesqrt)
RTSL_EXPORT_BINARY(pow)
RTSL_EXPORT_BINARY(atan2) // (y, x)
RTSL_EXPORT_REFRACT(1)
RTSL_EXPORT_REFRACT(2)
RTSL_EXPORT_REFRACT(3)
RTSL_EXPORT_REFRACT(4)

#if defined(__AVX2__) && defined(__FMA__)
[[gnu::const]] __m128 rtsl_pow4(__m128 x, __m128 y) {
  return rtsl::device::pow(x, y);
}
#endif

} // extern "C"
