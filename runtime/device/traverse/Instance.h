//===- Instance.h - rays, points and normals between two spaces -----------===//
//
// An instance with a transform is tested in its object space: the ray is transformed, not the
// geometry. Distances along a ray are the same in both spaces, because its direction keeps the
// length that the inverse transform gives it.
//
// Far from the origin, or in a scaled space, rounding in world space may exceed the size of the
// whole object. So a ray's origin is transformed in double, relative to the translation, and
// rounded once, in object space. That rounding is part of the error of a hit point
// (transformedPointError), which the rays that leave it allow for.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/ray/Abi.h"
#include "runtime/device/ray/Hit.h"
#include "runtime/device/ray/Spawn.h"
#include "runtime/device/ray/Vector.h"
#include "runtime/device/traverse/Bvh.h"
#include "runtime/device/traverse/Motion.h"
#include "runtime/device/traverse/Triangle.h"

namespace rtsl::device {

/// Has the scene instances with transforms? Folds to a constant in a compiled program.
inline bool hasTransforms(const RtslLaunch &launch) {
  return (rtsl_needs(&launch) & RTSL_HAS_TRANSFORMS) != 0;
}
inline bool isTransformed(const RtslLaunch &launch, const RtslInstance &instance) {
  return instance.transform != 0 && hasTransforms(launch);
}

/// A transform of the launch, by its index, at a time. One that does not move is not copied.
class TransformAt {
public:
  TransformAt(const RtslLaunch &launch, uint32_t number, float time)
      : used(launch.transforms + number) {
    if (!moves(launch, *used))
      return;
    moved = transformAt(launch, *used, time);
    used = &moved;
  }
  TransformAt(const RtslLaunch &launch, const RtslInstance &instance, float time)
      : TransformAt(launch, instance.transform, time) {}
  TransformAt(const TransformAt &) = delete;
  operator const RtslTransform &() const { return *used; }

private:
  const RtslTransform *used;
  RtslTransform moved;
};

/// A 3x3 matrix of doubles, stored as columns, times a vector. A component that is 0 is +0, as in a
/// product with the identity (positive() below).
inline Vec3 product(const double m[9], double x, double y, double z) {
  return {float(__builtin_fma(m[6], z, __builtin_fma(m[3], y, __builtin_fma(m[0], x, 0.0)))),
          float(__builtin_fma(m[7], z, __builtin_fma(m[4], y, __builtin_fma(m[1], x, 0.0)))),
          float(__builtin_fma(m[8], z, __builtin_fma(m[5], y, __builtin_fma(m[2], x, 0.0))))};
}
/// The product with a diagonal matrix, to the bit.
inline Vec3 scaled(const double m[9], double x, double y, double z) {
  return {float(__builtin_fma(m[0], x, 0.0)), float(__builtin_fma(m[4], y, 0.0)),
          float(__builtin_fma(m[8], z, 0.0))};
}
/// The product with the identity.
inline Vec3 positive(Vec3 v) {
  return {v.x + 0.0f, v.y + 0.0f, v.z + 0.0f};
}

inline Vec3 pointToObject(const RtslTransform &transform, Vec3 p) {
  return product(transform.inverse, double(p.x) - double(transform.translation[0]),
                 double(p.y) - double(transform.translation[1]),
                 double(p.z) - double(transform.translation[2]));
}
inline Vec3 vectorToObject(const RtslTransform &transform, Vec3 v) {
  return product(transform.inverse, double(v.x), double(v.y), double(v.z));
}
inline Vec3 pointToObject(const RtslLaunch &launch, const RtslTransform &transform, Vec3 p) {
  if (hasTurns(launch))
    return pointToObject(transform, p);
  const float *t = transform.translation;
  if (hasLinear(launch))
    return scaled(transform.inverse, double(p.x) - double(t[0]), double(p.y) - double(t[1]),
                  double(p.z) - double(t[2]));
  // The difference of two floats in double, rounded to float, is their difference in float.
  return positive(p - load(t));
}
inline Vec3 vectorToObject(const RtslLaunch &launch, const RtslTransform &transform, Vec3 v) {
  if (hasTurns(launch))
    return vectorToObject(transform, v);
  return hasLinear(launch) ? scaled(transform.inverse, double(v.x), double(v.y), double(v.z))
                           : positive(v);
}

/// Of a mesh whose vertices were transformed to world space, the index of that transform in the
/// launch's; otherwise 0.
inline uint32_t appliedTransform(const RtslInstance &instance) {
  return instance.primitive == 0 && instance.transform == 0 ? instance.firstBox : 0;
}

/// Component `row` of the linear part times a vector, plus `offset`, rounded once.
inline float rowToWorld(const RtslTransform &transform, int row, Vec3 v, double offset) {
  const float *m = transform.linear;
  return float(
      __builtin_fma(double(m[row]), double(v.x),
                    __builtin_fma(double(m[3 + row]), double(v.y),
                                  __builtin_fma(double(m[6 + row]), double(v.z), offset))));
}

/// The transpose of the inverse times a scaled vector, plus an offset, rounded once.
inline Vec3 transposedProduct(const double m[9], Vec3 v, Vec3 offset, double scale = 1) {
  const double x = scale * double(v.x), y = scale * double(v.y), z = scale * double(v.z);
  const auto row = [&](int i, float added) {
    return float(
        __builtin_fma(m[3 * i + 2], z,
                      __builtin_fma(m[3 * i + 1], y, __builtin_fma(m[3 * i], x, double(added)))));
  };
  return {row(0, offset.x), row(1, offset.y), row(2, offset.z)};
}

inline Vec3 pointToWorld(const RtslTransform &transform, Vec3 p) {
  const float *t = transform.translation;
  if (transform.squaredScale > 0)
    return transposedProduct(transform.inverse, p, load(t), transform.squaredScale);
  return {rowToWorld(transform, 0, p, double(t[0])), rowToWorld(transform, 1, p, double(t[1])),
          rowToWorld(transform, 2, p, double(t[2]))};
}
inline Vec3 vectorToWorld(const RtslTransform &transform, Vec3 v) {
  if (transform.squaredScale > 0)
    return transposedProduct(transform.inverse, v, {0, 0, 0}, transform.squaredScale);
  return {rowToWorld(transform, 0, v, 0), rowToWorld(transform, 1, v, 0),
          rowToWorld(transform, 2, v, 0)};
}

/// A vector by a transform without turns. Translations are not -0, so no sum is.
inline Vec3 scaledToWorld(const RtslTransform &transform, Vec3 v, Vec3 offset) {
  const float *m = transform.linear;
  return {float(__builtin_fma(double(m[0]), double(v.x), double(offset.x))),
          float(__builtin_fma(double(m[4]), double(v.y), double(offset.y))),
          float(__builtin_fma(double(m[8]), double(v.z), double(offset.z)))};
}

/// A vector by a transform that is a rotation with a uniform scale, or a scale alone.
inline Vec3 similarToWorld(const RtslLaunch &launch, const RtslTransform &transform, Vec3 v,
                           Vec3 offset) {
  if (!hasScale(launch))
    return transposedProduct(transform.inverse, v, offset);
  return transform.squaredScale > 0
             ? transposedProduct(transform.inverse, v, offset, transform.squaredScale)
             : scaledToWorld(transform, v, offset);
}

inline Vec3 pointToWorld(const RtslLaunch &launch, const RtslTransform &transform, Vec3 p) {
  const Vec3 translation = load(transform.translation);
  if (hasTurns(launch))
    return hasStretch(launch) ? pointToWorld(transform, p)
                              : similarToWorld(launch, transform, p, translation);
  return hasLinear(launch) ? scaledToWorld(transform, p, translation) : positive(p + translation);
}
inline Vec3 vectorToWorld(const RtslLaunch &launch, const RtslTransform &transform, Vec3 v) {
  if (hasTurns(launch))
    return hasStretch(launch) ? vectorToWorld(transform, v)
                              : similarToWorld(launch, transform, v, {0, 0, 0});
  return hasLinear(launch) ? scaledToWorld(transform, v, {0, 0, 0}) : positive(v);
}

/// The inverse transpose times a vector: not normalised.
inline Vec3 covectorToWorld(const RtslTransform &transform, Vec3 n) {
  return transposedProduct(transform.inverse, n, {0, 0, 0});
}
inline Vec3 covectorToWorld(const RtslLaunch &launch, const RtslTransform &transform, Vec3 n) {
  if (hasTurns(launch))
    return covectorToWorld(transform, n);
  return hasLinear(launch) ? scaled(transform.inverse, double(n.x), double(n.y), double(n.z))
                           : positive(n);
}
/// A normal: of length 1, and on the same side of the surface.
inline Vec3 normalToWorld(const RtslLaunch &launch, const RtslTransform &transform, Vec3 n) {
  return normalized(covectorToWorld(launch, transform, n));
}

/// Bound of the error, in any component in world space, of a vector whose components in object
/// space have these errors.
inline float errorToWorld(const RtslLaunch &launch, const RtslTransform &transform, Vec3 error) {
  if (!hasLinear(launch))
    return largest(error);
  const float *m = transform.linear;
  if (!hasTurns(launch))
    return largest({m[0] * error.x, m[4] * error.y, m[8] * error.z});
  const auto row = [&](int i) {
    return absolute(m[i]) * error.x + absolute(m[3 + i]) * error.y + absolute(m[6 + i]) * error.z;
  };
  return maximum(maximum(row(0), row(1)), row(2));
}

/// Bound of |p - surface| in world space for a point of an instance with a transform. In object
/// space, components of the point and of the surface it was computed from are at most `size`;
/// `world` is the point. A component is rounded once when the point is computed, and once more when
/// the origin of a ray that leaves it is transformed back.
inline float transformedPointError(const RtslLaunch &launch, const RtslTransform &transform,
                                   Vec3 size, Vec3 world) {
  return trianglePointUnits * roundingUnit *
         (2 * errorToWorld(launch, transform, size) + largest(world));
}

/// A ray in the space of an instance that it has entered.
struct InstanceRay : TriangleRay {
  uint32_t instance;
  Range range; // in the instance's box, widened: hits are moved into it, as in moveIntoBox
};

/// A ray that is in world space, or in that of an instance that it has entered.
struct SearchRay : InstanceRay {
  explicit SearchRay(const TriangleRay &world) { leaveInstance(world); }

  bool isInWorld() const { return instance == RTSL_NO_HIT; }

  void leaveInstance(const TriangleRay &world) {
    static_cast<TriangleRay &>(*this) = world;
    instance = RTSL_NO_HIT;
    range = {-infinity, infinity};
  }
};

/// The ray in the object space of an instance with a transform, at a time. False if it cannot hit
/// anything there before `limit`: its direction vanishes in object space, or it misses the
/// instance's box, as it then does in every traversal.
inline bool enterInstance(const RtslLaunch &launch, const TriangleRay &world, uint32_t number,
                          float time, float epsilon, float limit, InstanceRay &entered) {
  const RtslInstance &instance = instanceAt(launch, number);
  const Range range =
      rangeInBox(instance.lower, instance.upper, world.origin, world.inverse, 0, infinity);
  if (range.isEmpty())
    return false;
  const Range widened = range.widened();
  if (widened.near > limit || widened.far < epsilon)
    return false;
  const TransformAt transform(launch, instance, time);
  const Vec3 origin = pointToObject(launch, transform, dependingOn(range.near, world.origin));
  const Vec3 direction =
      vectorToObject(launch, transform, dependingOn(range.near, world.direction));
  if (!isFinite(origin) || !isFinite(direction) || isZero(direction))
    return false;
  static_cast<TriangleRay &>(entered) = makeTriangleRay(origin, direction);
  entered.instance = number;
  entered.range = widened;
  return true;
}

/// The number of the instance that a triangle belongs to, in a ray's space.
inline uint32_t instanceOf(const TriangleRay &, uint32_t ofTriangle) {
  return ofTriangle;
}
inline uint32_t instanceOf(const InstanceRay &ray, uint32_t) {
  return ray.instance;
}

/// Moves t into the range of the ray in its instance's box.
inline float moveIntoInstance(const TriangleRay &, float t) {
  return t;
}
inline float moveIntoInstance(const InstanceRay &ray, float t) {
  return movedInto(ray.range, t);
}

/// The state's ray in object space while code of an RTSL primitive runs; world space again when it
/// goes out of scope. Without a transform it does nothing.
class InObjectSpace {
public:
  /// `transform`: an index into the launch's transforms, as RtslInstance::transform.
  InObjectSpace(RtslState &state, uint32_t transform)
      : state(state), isActive(transform != 0 && hasTransforms(*state.launch)) {
    if (isActive)
      enter(transform);
  }
  InObjectSpace(RtslState &state, const RtslInstance &instance)
      : InObjectSpace(state, instance.transform) {}
  /// The same for a ray that is in world space, or has entered the instance.
  InObjectSpace(RtslState &state, const RtslInstance &instance, const TriangleRay &)
      : InObjectSpace(state, instance.transform) {}
  InObjectSpace(RtslState &state, const RtslInstance &, const InstanceRay &entered)
      : state(state), isActive(true) {
    enter(entered.origin, entered.direction);
  }
  InObjectSpace(RtslState &state, const RtslInstance &instance, const SearchRay &ray)
      : state(state), isActive(!ray.isInWorld() || isTransformed(*state.launch, instance)) {
    if (isActive && ray.isInWorld())
      enter(instance.transform);
    else if (isActive)
      enter(ray.origin, ray.direction);
  }
  InObjectSpace(const InObjectSpace &) = delete;
  ~InObjectSpace() {
    if (isActive)
      setRay(origin, direction);
  }

private:
  void enter(uint32_t transform) {
    const TransformAt toWorld(*state.launch, transform, state.Time);
    enter(pointToObject(*state.launch, toWorld, load(state.RayOrigin)),
          vectorToObject(*state.launch, toWorld, load(state.RayDirection)));
  }
  void enter(Vec3 from, Vec3 towards) {
    origin = load(state.RayOrigin);
    direction = load(state.RayDirection);
    setRay(from, towards);
  }
  void setRay(Vec3 from, Vec3 towards) {
    store(state.RayOrigin, from);
    store(state.RayDirection, towards);
    if (rtsl_needs(state.launch) & RTSL_NEEDS_INVERSE_DIRECTION)
      store(state.InverseRayDirection, {1.0f / towards.x, 1.0f / towards.y, 1.0f / towards.z});
  }

  RtslState &state;
  const bool isActive;
  Vec3 origin = {}, direction = {};
};

/// The matrices of a transform, an index into the launch's, for RTSL_NEEDS_TRANSFORMS.
inline void describeTransforms(RtslState &state, uint32_t number) {
  for (int i = 0; i < 16; ++i)
    state.ObjectToWorld[i] = state.WorldToObject[i] = i % 5 == 0 ? 1.0f : 0.0f;
  if (number == 0)
    return;
  const TransformAt atTime(*state.launch, number, state.Time);
  const RtslTransform &transform = atTime;
  const Vec3 origin = pointToObject(transform, {0, 0, 0});
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row) {
      state.ObjectToWorld[4 * column + row] = transform.linear[3 * column + row];
      state.WorldToObject[4 * column + row] = float(transform.inverse[3 * column + row]);
    }
  for (int row = 0; row < 3; ++row) {
    state.ObjectToWorld[12 + row] = transform.translation[row];
    state.WorldToObject[12 + row] = origin[row];
  }
}
inline void describeTransforms(RtslState &state, const RtslInstance &instance) {
  const uint32_t applied = appliedTransform(instance);
  describeTransforms(state, applied != 0 ? applied : instance.transform);
}

} // namespace rtsl::device
