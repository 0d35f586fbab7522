//===- Spawn.h - the start of a ray that leaves a surface -----------------===//
//
// A computed hit point is off its surface by rounding. A ray that starts there must not hit that
// surface again, and must miss as little else as possible; so rt_Epsilon is computed from a bound
// of that distance, not a constant.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/ray/Box.h"
#include "runtime/device/ray/Rough.h"
#include "runtime/device/ray/State.h"
#include "runtime/device/ray/Vector.h"

namespace rtsl::device {

// Bounds are in rounding units of the quantity that they refer to.
//
// A point of a triangle is interpolated in double and rounded once a coordinate: within sqrt(3)
// units of the largest coordinate from the plane, whatever the weights.
constexpr float trianglePointUnits = 2;
// The next test of the triangle adds no significant error: it computes near hits in double
// (depthNearOrigin in runtime/device/traverse/Triangle.h).
// A point from an author's own arithmetic, near coordinates of this size.
constexpr float foreignPointUnits = 20;
// A point of an RTSL primitive is o + t d: 2 units for itself, and the error of the author's t.
// If that is not known, this is assumed: a quadric solved without cancellation (differences from
// its centre, r^2 - |f - (f.d) d|^2) is exact to about 8 units of the distances in it; the same
// again for the next test.
constexpr float primitiveErrorUnits = 24;
// If the ray grazes the surface, the error of t exceeds the distance of the point from the surface,
// but not without bound, because the surface curves.
constexpr float smallestHitCosine = 0x1p-4f;

/// Bound of |p - surface| for p = o + t d on an RTSL primitive with an unknown error of t.
inline float primitivePointError(Vec3 origin, Vec3 direction, float t) {
  return primitiveErrorUnits * roundingUnit * (largest(origin) + absolute(t) * largest(direction));
}

/// The same for an error of t of at most `error`, which moves the point along the ray, and off the
/// surface by that times the cosine to the normal. Doubled, because the next test has the same
/// error.
inline float primitivePointError(Vec3 point, Vec3 direction, float error, Vec3 normal) {
  const float rounding = trianglePointUnits * roundingUnit * largest(point);
  const float squares = dot(direction, direction), across = dot(normal, normal);
  const float length = roughRoot(squares);
  if (!(squares > 0x1p-60f && squares < 0x1p60f && across > 0x1p-60f && across < 0x1p60f))
    return 4 * error * largest(direction) + rounding; // a vector is at most sqrt(3) of its largest
  const float along = roughQuotient(absolute(dot(direction, normal)), roughRoot(across));
  return 2 * error * maximum(along, smallestHitCosine * length) + rounding;
}

/// Bound of |p - surface| for a triangle's point.
inline float trianglePointError(Vec3 v0, Vec3 v1, Vec3 v2) {
  float coordinate = maximum(maximum(largest(v0), largest(v1)), largest(v2));
  return trianglePointUnits * roundingUnit * coordinate;
}

/// Nearly parallel to the surface epsilon would grow without bound: this is the smallest cosine
/// used.
constexpr float smallestCosine = 0x1p-12f;

/// spawnEpsilon for vectors whose squares would leave the range of a float.
__attribute__((cold)) inline float spawnEpsilonOfExtremes(float error, Vec3 normal,
                                                          Vec3 direction) {
  Vec3 unit = normalized(direction);
  float cosine = absolute(dot(unit, normalized(normal)));
  cosine = cosine > smallestCosine ? (cosine < 1 ? cosine : 1.0f) : smallestCosine;
  // |direction| without overflow: its component along the unit vector.
  return error / (cosine * dot(direction, unit));
}

/// Epsilon near the hit point, where the surface and the angle to it are known; `error` bounds the
/// distance of the origin from the surface.
inline float epsilonAtSurface(float error, Vec3 normal, Vec3 direction) {
  float along = absolute(dot(direction, normal));
  float square = dot(direction, direction), squares = square * dot(normal, normal);
  if (!(square > 0x1p-60f && squares > 0x1p-60f && squares < 0x1p60f))
    return spawnEpsilonOfExtremes(error, normal, direction);
  // The sum is at least the length, at most 1.74 times as much, and needs no square root: the bound
  // may be larger than necessary.
  if (along * along > smallestCosine * smallestCosine * squares)
    return roughQuotient(error * (absolute(normal.x) + absolute(normal.y) + absolute(normal.z)),
                         along);
  return roughQuotient(error, smallestCosine * roughRoot(square));
}

/// The start of a ray that a shader sends.
struct RayStart {
  float epsilon;   // in units of its direction
  uint32_t isEasy; // result of isEasySpawn
  uint32_t leaves; // RtslState::leaves
  uint32_t leavesPrimitive;
};

/// RtslState::leavesPrimitive of rays that leave the hit of `parent`. Its `primitive` is not kept
/// while it waits for a ray.
inline uint32_t leftPrimitive(const RtslState &parent) {
  return hasCounts(*parent.launch) ? uint32_t(parent.PrimitiveIndex) : 0;
}

/// The hit that determines how rays start that leave it.
struct LeftHit {
  uint32_t instance; // RTSL_NO_HIT: there is none
  uint32_t primitive;
  Vec3 point, normal;
  float error; // bound of the distance of the point from the surface
};

inline LeftHit leftHit(const RtslState &parent) {
  if (!rtsl_rays_leave_hits())
    return {RTSL_NO_HIT, 0, {0, 0, 0}, {0, 0, 0}, 0};
  return {parent.instance, leftPrimitive(parent), load(parent.HitPoint),
          load(parent.GeometricNormal), parent.hitPointError};
}

/// Does the ray start where a surface was hit? Nearly all do.
inline bool startsAtHit(const LeftHit &hit, Vec3 origin) {
  return hit.instance != RTSL_NO_HIT && origin.x == hit.point.x && origin.y == hit.point.y &&
         origin.z == hit.point.z;
}

/// Can every traversal handle a ray as it is: finite, and of a size whose squares and reciprocals
/// stay in range? True only for rays that start at the hit point, whose error bounds its size: it
/// is at least 2^-23 of the largest coordinate. Other rays are checked when they are traced.
inline bool isEasySpawn(const LeftHit &hit, Vec3 origin, Vec3 direction) {
  float square = dot(direction, direction);
  return startsAtHit(hit, origin) && hit.error < 0x1p36f && square > 0x1p-38f && square < 0x1p38f;
}

/// The rounding of an origin of which nothing is known but its size.
inline float foreignError(Vec3 origin) {
  return foreignPointUnits * roundingUnit * largest(origin);
}

/// startOf for rays that leave no surface, as those of cameras.
inline RayStart startInSpace(uint32_t primitive, Vec3 origin, Vec3 direction) {
  float length = largest(direction);
  return {length > 0 && length < infinity ? roughQuotient(foreignError(origin), length) : 0.0f, 0,
          RTSL_NO_HIT, primitive};
}

/// startOf for origins that are not the hit point. It is passed values, so that a state in
/// registers stays there.
__attribute__((cold, const, noinline)) inline RayStart startElsewhere(LeftHit hit, Vec3 origin,
                                                                      Vec3 direction) {
  RayStart start = startInSpace(hit.primitive, origin, direction);
  float foreign = foreignError(origin), length = largest(direction);
  if (hit.instance == RTSL_NO_HIT || !(length > 0 && length < infinity))
    return start;
  // Only near the hit point are the surface and its normal known.
  float error = hit.error, away = largest(origin - hit.point);
  if (!(away <= 64 * maximum(foreign, error))) {
    start.epsilon = maximum(foreign, error) / length;
    return start;
  }
  if (away != 0) // it was moved, which rounded it again
    error += trianglePointUnits * roundingUnit * largest(origin);
  start.epsilon = epsilonAtSurface(error, hit.normal, direction);
  start.leaves = hit.instance;
  return start;
}

/// The start of a ray that a shader sends from `origin`. Leaving a surface at an angle with cosine
/// c to the normal, a ray that starts d below it crosses it at distance d / c; what is skipped
/// until then is within d of the tangent plane. So epsilon is d |n| / |direction . n|.
__attribute__((always_inline)) inline RayStart startOf(const LeftHit &hit, Vec3 origin,
                                                       Vec3 direction) {
  if (isEasySpawn(hit, origin, direction))
    return {epsilonAtSurface(hit.error, hit.normal, direction), 1, hit.instance, hit.primitive};
  if (hit.instance == RTSL_NO_HIT)
    return startInSpace(hit.primitive, origin, direction);
  return startElsewhere(hit, origin, direction);
}
__attribute__((always_inline)) inline RayStart startOf(const RtslState &parent, Vec3 origin,
                                                       Vec3 direction) {
  return startOf(leftHit(parent), origin, direction);
}

inline float spawnEpsilon(const RtslState &parent, Vec3 origin, Vec3 direction) {
  return startOf(parent, origin, direction).epsilon;
}

} // namespace rtsl::device
