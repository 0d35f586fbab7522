//===- Geometry.h - dot, length, normalize, refract, ... ------------------===//
//
// Sums are evaluated from the first term to the last. If a difference could cancel, products use
// Kahan's method; if squares would leave the range of a float, vectors are scaled first. With
// RTSL_FAST compilers may fuse, a division is a multiplication by the reciprocal, and lengths above
// 2^64 are infinite.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "rtsl/shader/Common.h"
#include "rtsl/shader/Integers.h"

extern "C" {
#define RTSL_DECLARE_REFRACT(count)                                                                \
  void rtsl_refract##count(const float *incident, const float *normal, float eta, float *refracted);
RTSL_DECLARE_REFRACT(1)
RTSL_DECLARE_REFRACT(2)
RTSL_DECLARE_REFRACT(3)
RTSL_DECLARE_REFRACT(4)
#undef RTSL_DECLARE_REFRACT
}

namespace rtsl {
inline namespace RTSL_VARIANT {

/// a b - c d within 1.5 ulp, and exactly 0 for a b == c d (Jeannerod, Louvet, Muller, "Further
/// analysis of Kahan's algorithm for the accurate computation of 2 x 2 determinants", 2013).
inline float differenceOfProducts(float a, float b, float c, float d) {
#if defined(RTSL_FAST)
  return a * b - c * d;
#else
  const float product = c * d;
  const float error = std::fma(-c, d, product); // exact
  return std::fma(a, b, -product) + error;
#endif
}

inline float dot(float a, float b) {
  return a * b;
}
inline float dot(const glm::vec2 &a, const glm::vec2 &b) {
  return a.x * b.x + a.y * b.y;
}
inline float dot(const glm::vec3 &a, const glm::vec3 &b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline float dot(const glm::vec4 &a, const glm::vec4 &b) {
  return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w;
}

inline glm::vec3 cross(const glm::vec3 &a, const glm::vec3 &b) {
  return {differenceOfProducts(a.y, b.z, a.z, b.y), differenceOfProducts(a.z, b.x, a.x, b.z),
          differenceOfProducts(a.x, b.y, a.y, b.x)};
}

namespace detail {
/// May the square root of a sum of squares be taken directly? If it is smaller, subnormal squares
/// could affect the last digits of the sum; if it is larger, it has overflowed.
inline bool isGoodSquare(float square) {
#if defined(RTSL_FAST)
  return isLikely(0x1p-96f <= square);
#else
  // The bits of non-negative numbers are ordered like the numbers, with NaN above all.
  constexpr uint least = 0x0f800000u, infinite = 0x7f800000u; // 2^-96
  return isLikely(bitsAs<uint>(square) - least < infinite - least);
#endif
}
/// The same, if nothing is divided by the root: faster with g++ (bench/run shaders).
inline bool isGoodSquareOfLength(float square) {
#if defined(__GNUC__) && !defined(__clang__) && !defined(RTSL_FAST)
  return isLikely(0x1p-96f <= square && !(infinity <= square));
#else
  return detail::isGoodSquare(square);
#endif
}
/// An exact factor for a vector, so that its squares stay in the range of a float.
inline float scaleOfBadSquare([[maybe_unused]] float square) {
#if defined(RTSL_FAST)
  return 0x1p100f;
#else
  return 1.0f < square ? 0x1p-70f : 0x1p100f;
#endif
}
/// v / root.
template <typename T>
inline T quotient(const T &v, float root) {
#if defined(RTSL_FAST)
  return v * (1.0f / root);
#else
  return v / root;
#endif
}
} // namespace detail

/// Within 2 ulp, for vectors of any length.
template <typename T>
inline float length(const T &v) {
  if constexpr (width<T> == 0) {
    return std::fabs(v);
  } else {
    const float square = rtsl::dot(v, v);
    if (detail::isGoodSquareOfLength(square))
      return rtsl::squareRoot(square);
    const float scale = detail::scaleOfBadSquare(square);
    const T scaled = v * scale;
    return rtsl::squareRoot(rtsl::dot(scaled, scaled)) / scale;
  }
}

/// v / length(v), each component within 2.5 ulp; the zero vector gives the zero vector.
template <typename T>
inline T normalize(const T &v) {
  if constexpr (width<T> == 0) {
    return v == 0.0f ? v : v / std::fabs(v);
  } else {
    const float square = rtsl::dot(v, v);
    if (detail::isGoodSquare(square))
      return detail::quotient(v, rtsl::squareRoot(square));
    const T scaled = v * detail::scaleOfBadSquare(square);
    const float scaledSquare = rtsl::dot(scaled, scaled);
    return scaledSquare == 0.0f ? scaled : scaled / rtsl::squareRoot(scaledSquare);
  }
}

template <typename T>
inline float distance(const T &a, const T &b) {
  return rtsl::length(a - b);
}
template <typename T>
inline T faceforward(const T &n, const T &i, const T &reference) {
  return rtsl::dot(reference, i) < 0.0f ? n : rtsl::negate(n);
}
template <typename T>
inline T reflect(const T &i, const T &n) {
  return i - (2.0f * rtsl::dot(n, i)) * n;
}
/// Rounded once, with total reflection decided exactly (math/Refraction.h).
template <typename T>
inline T refract(const T &i, const T &n, float eta) {
  T refracted;
  if constexpr (width<T> == 0)
    rtsl_refract1(&i, &n, eta, &refracted);
  else if constexpr (width<T> == 2)
    rtsl_refract2(&i.x, &n.x, eta, &refracted.x);
  else if constexpr (width<T> == 3)
    rtsl_refract3(&i.x, &n.x, eta, &refracted.x);
  else
    rtsl_refract4(&i.x, &n.x, eta, &refracted.x);
  return refracted;
}

/// The index of the component of largest magnitude; the lowest on a tie.
template <typename T>
inline int dominantAxis(const T &v) {
  const T magnitude = rtsl::abs(v);
  int axis = 0;
  for (int i = 1; i < width<T>; ++i)
    if (magnitude[axis] < magnitude[i])
      axis = i;
  return axis;
}

/// A unit vector perpendicular to v, in the plane of its middle axis and the larger of the others
/// (Hughes and Moeller, "Building an Orthonormal Basis from a Unit Vector", 1999). The zero vector
/// gives the x axis.
inline glm::vec3 perpendicularTo(const glm::vec3 &v) {
  const bool inXY = std::fabs(v.z) < std::fabs(v.x);
  const glm::vec3 across =
      rtsl::normalize(inXY ? glm::vec3(-v.y, v.x, 0.0f) : glm::vec3(0.0f, -v.z, v.y));
  return across == glm::vec3(0.0f) ? glm::vec3(1.0f, 0.0f, 0.0f) : across;
}

} // namespace RTSL_VARIANT
} // namespace rtsl
