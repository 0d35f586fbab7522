//===- Footprint.h - the part of a surface that a ray stands for ----------===//
//
// A ray is the axis of a cone (Amanatides, "Ray Tracing with Cones", 1984), which is as wide as a
// pixel: two numbers a ray, its width where the ray starts and what it gains per unit of length.
// The cone meets the tangent plane of the surface in an ellipse (Akenine-Moeller and others,
// "Improved Shader and Texture Level of Detail Using Ray Cones", JCGT 2021), whose axes are dPdx
// and dPdy. Their images in texture space, by dPdu and dPdv, are dUVdx and dUVdy.
//
// Only programs with RTSL_NEEDS_FOOTPRINT contain this. Lengths are in world space. A footprint
// that cannot be computed is 0, which selects the finest level of an image.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/ray/Needs.h"
#include "runtime/device/ray/State.h"
#include "runtime/device/ray/Vector.h"
#include "runtime/device/traverse/Instance.h"

namespace rtsl::device {

/// What must be computed of a hit to find its footprint, beside what its material reads.
inline uint32_t withFootprint(uint32_t needs) {
  return needs & RTSL_NEEDS_FOOTPRINT ? needs | RTSL_NEEDS_NORMALS | RTSL_NEEDS_DERIVATIVES : needs;
}

/// No footprint.
inline void clearFootprint(RtslState &state, uint32_t needs) {
  if (needs & RTSL_NEEDS_NORMAL_CHANGES) {
    store(state.dNdx, {0, 0, 0});
    store(state.dNdy, {0, 0, 0});
  }
  store(state.dPdx, {0, 0, 0});
  store(state.dPdy, {0, 0, 0});
  state.dUVdx[0] = state.dUVdx[1] = state.dUVdy[0] = state.dUVdy[1] = 0;
  store(state.dUVWdx, {0, 0, 0});
  store(state.dUVWdy, {0, 0, 0});
}

/// The width of the cone at the hit, at most this, so that squares of lengths stay finite.
inline float coneWidthAtHit(const RtslState &state) {
  constexpr float most = 0x1p+40f;
  const Vec3 direction = load(state.RayDirection);
  const float length = state.HitDistance * squareRoot(dot(direction, direction));
  const float width = fused(state.ConeSpread, length, state.coneAtOrigin);
  return width > 0 ? minimum(width, most) : 0; // 0: NaN, too
}

/// The axes of the ellipse in which a cone of width 1 along `direction` meets the plane with this
/// normal; both have length 1. `along` is the longer one.
struct FootprintAxes {
  Vec3 along, across;
  float stretch; // the length of the longer one
};

inline FootprintAxes footprintAxes(Vec3 direction, Vec3 normal) {
  constexpr float mostStretch = 0x1p+10f; // of a ray that grazes the surface
  FootprintAxes axes;
  Vec3 across = cross(normal, direction);
  if (!(largest(across) > 0x1p-20f)) { // a circle: any axes will do
    const bool isAlongX = absolute(normal.x) > 0.5f;
    across = cross(normal, {isAlongX ? 0.0f : 1.0f, isAlongX ? 1.0f : 0.0f, 0.0f});
  }
  axes.across = normalized(across);
  axes.along = cross(axes.across, normal);
  axes.stretch = minimum(1 / absolute(dot(normal, direction)), mostStretch);
  return axes;
}

/// Solves dP = du u + dv v for vectors dP of the plane of `du` and `dv`: writes (u, v) for `x` and
/// `y`. Where `du` and `dv` do not span a plane, it writes nothing.
inline void solveForCoordinates(Vec3 du, Vec3 dv, Vec3 x, Vec3 y, float *ofX, float *ofY) {
  const float lengthU = squareRoot(dot(du, du)), lengthV = squareRoot(dot(dv, dv));
  if (!(lengthU > 0x1p-60f && lengthV > 0x1p-60f && lengthU < 0x1p+60f && lengthV < 0x1p+60f))
    return;
  const Vec3 u = du * (1 / lengthU), v = dv * (1 / lengthV);
  const Vec3 normal = cross(u, v);
  const float square = dot(normal, normal); // of the sine of their angle
  if (!(square > 0x1p-20f))
    return;
  // The reciprocal basis: of a vector outside of the plane it takes the part inside.
  const Vec3 toU = cross(v, normal) * (1 / (square * lengthU));
  const Vec3 toV = cross(normal, u) * (1 / (square * lengthV));
  ofX[0] = dot(x, toU);
  ofX[1] = dot(x, toV);
  ofY[0] = dot(y, toU);
  ofY[1] = dot(y, toV);
}

/// The footprint of the state's ray at its hit, of which ConeWidth, the normal and the derivatives
/// are known in world space.
inline void describeFootprint(RtslState &state, const RtslInstance &instance, uint32_t needs) {
  const RtslLaunch &launch = *state.launch;
  const float width = state.ConeWidth;
  clearFootprint(state, needs);
  const Vec3 normal = normalized(load(state.GeometricNormal));
  const Vec3 direction = normalized(load(state.RayDirection));
  if (!(width > 0) || !(largest(normal) > 0) || !isFinite(normal) || !isFinite(direction))
    return;
  const FootprintAxes axes = footprintAxes(direction, normal);
  const Vec3 x = axes.along * (width * axes.stretch), y = axes.across * width;
  store(state.dPdx, x);
  store(state.dPdy, y);
  solveForCoordinates(load(state.dPdu), load(state.dPdv), x, y, state.dUVdx, state.dUVdy);
  // The third coordinates are the point in object space.
  if (isTransformed(launch, instance)) {
    const TransformAt transform(launch, instance, state.Time);
    store(state.dUVWdx, vectorToObject(launch, transform, x));
    store(state.dUVWdy, vectorToObject(launch, transform, y));
  } else if (const uint32_t applied = appliedTransform(instance)) {
    store(state.dUVWdx, vectorToObject(launch.transforms[applied], x));
    store(state.dUVWdy, vectorToObject(launch.transforms[applied], y));
  } else {
    store(state.dUVWdx, x);
    store(state.dUVWdy, y);
  }
}

} // namespace rtsl::device
