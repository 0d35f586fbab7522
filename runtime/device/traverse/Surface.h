//===- Surface.h - state of the surface that was hit ----------------------===//
#pragma once

#include "runtime/device/ray/Abi.h"
#include "runtime/device/ray/HitError.h"
#include "runtime/device/ray/Spawn.h"
#include "runtime/device/ray/Vector.h"
#include "runtime/device/traverse/Candidate.h"
#include "runtime/device/traverse/Footprint.h"
#include "runtime/device/traverse/Instance.h"
#include "runtime/device/traverse/MeshAttributes.h"
#include "runtime/device/traverse/TestItem.h"

namespace rtsl::device {

/// The methods of the program that this code is linked into.
struct LinkedSlots {
#define RTSL_SLOT(base, method)                                                                    \
  static void base##_##method(RtslState *state, RtslRef object) {                                  \
    rtsl_##base##_##method(state, object);                                                         \
  }
#include "language/Slots.def"
};

inline void setVector(float *p, float x, float y, float z) {
  store(p, {x, y, z});
}

/// dP/du and dP/dv of a triangle from the texture coordinates of its vertices (0 where these do not
/// span the plane).
inline void triangleDerivatives(RtslState &state, const TriangleVertices &p, const float *uv0,
                                const float *uv1, const float *uv2) {
  Vec3 e1 = p.v1 - p.v0, e2 = p.v2 - p.v0;
  float u1 = uv1[0] - uv0[0], t1 = uv1[1] - uv0[1];
  float u2 = uv2[0] - uv0[0], t2 = uv2[1] - uv0[1];
  float determinant = differenceOfProducts(u1, t2, u2, t1);
  float reciprocal = determinant != 0 ? 1.0f / determinant : 0.0f;
  store(state.dPdu, (e1 * t2 - e2 * t1) * reciprocal);
  store(state.dPdv, (e2 * u1 - e1 * u2) * reciprocal);
}

/// One coordinate of a triangle's point. In double, because rounding here moves rays off their
/// surface; the three weights sum to 1 exactly, or nearly so.
inline float interpolated(float a, float b, float c, double u, double v) {
  return float(__builtin_fma(double(c), v, __builtin_fma(double(b), u, double(a) * ((1 - u) - v))));
}

/// The geometric normal of a triangle, and the shading normal from its mesh.
inline void triangleNormals(RtslState &state, const RtslMesh &mesh, const TriangleVertices &p,
                            const uint32_t *index) {
  float u = state.u, v = state.v, w = (1.0f - u) - v;
  Vec3 geometric = normalized(cross(p.v1 - p.v0, p.v2 - p.v0));
  Vec3 shading = geometric;
  if (mesh.normals) {
    const auto normal = [&](int corner) {
      return vertexAt(*state.launch, mesh, mesh.normals, index[corner], state.Time);
    };
    Vec3 sum = normal(0) * w + normal(1) * u + normal(2) * v;
    if (!isZero(sum)) { // normals may cancel, or be 0 in the file
      shading = normalized(sum);
      // The file's normals tell which side is outside; its winding is less often right.
      if (dot(geometric, shading) < 0)
        geometric = geometric * -1.0f;
    }
  }
  store(state.GeometricNormal, geometric);
  store(state.ShadingNormal, shading);
}

/// Largest magnitudes of the coordinates, by axis.
inline Vec3 extents(const TriangleVertices &p) {
  const auto along = [&](int axis) {
    return maximum(maximum(absolute(p.v0[axis]), absolute(p.v1[axis])), absolute(p.v2[axis]));
  };
  return {along(0), along(1), along(2)};
}

/// Converts what was computed of a hit in the object space of its instance to world space.
/// Coordinates in its computation were at most `size`, by axis; the point is within `offSurface` of
/// the surface, not counting its own rounding.
inline void surfaceToWorld(RtslState &state, const RtslTransform &transform, uint32_t needs,
                           Vec3 size, float offSurface) {
  const RtslLaunch &launch = *state.launch;
  const Vec3 point = pointToWorld(launch, transform, load(state.HitPoint));
  store(state.HitPoint, point);
  state.hitPointError = transformedPointError(launch, transform, size, point);
  if (needs & RTSL_NEEDS_NORMALS) {
    const Vec3 geometric = load(state.GeometricNormal), shading = load(state.ShadingNormal);
    if (offSurface > 0) {
      // Parallel planes at a distance d have the distance d / |inverse transpose of n|.
      const Vec3 covector = covectorToWorld(launch, transform, normalized(geometric));
      const float length = squareRoot(dot(covector, covector));
      state.hitPointError +=
          length > 0 && length < infinity
              ? offSurface / length
              : 3 * errorToWorld(launch, transform, {offSurface, offSurface, offSurface});
    }
    store(state.GeometricNormal, normalToWorld(launch, transform, geometric));
    store(state.ShadingNormal, normalToWorld(launch, transform, shading));
  }
  if (needs & RTSL_NEEDS_DERIVATIVES) {
    store(state.dPdu, vectorToWorld(launch, transform, load(state.dPdu)));
    store(state.dPdv, vectorToWorld(launch, transform, load(state.dPdv)));
  }
}

/// Point, normals and texture coordinates of a mesh at state's hit, on the triangle `p`, in object
/// space.
inline void describeTriangle(RtslState &state, const RtslMesh &mesh, const TriangleVertices &p,
                             uint32_t needs) {
  const uint32_t *index = mesh.indices + 3 * size_t(state.primitive);
  float u = state.u, v = state.v, w = (1.0f - u) - v;
  store(state.HitPoint,
        {interpolated(p.v0.x, p.v1.x, p.v2.x, u, v), interpolated(p.v0.y, p.v1.y, p.v2.y, u, v),
         interpolated(p.v0.z, p.v1.z, p.v2.z, u, v)});
  state.hitPointError = trianglePointError(p.v0, p.v1, p.v2);

  if (needs & RTSL_NEEDS_NORMALS)
    triangleNormals(state, mesh, p, index);

  if (needs & (RTSL_NEEDS_TEXTURE_COORDINATES | RTSL_NEEDS_DERIVATIVES)) {
    // Without texture coordinates a triangle is its own unit triangle.
    static constexpr float own[3][2] = {{0, 0}, {1, 0}, {0, 1}};
    const auto uvOf = [&](int corner) {
      return mesh.uvs ? mesh.uvs + 2 * size_t(index[corner]) : own[corner];
    };
    state.TextureUV[0] = u;
    state.TextureUV[1] = v;
    if (mesh.uvs) {
      const float *uv0 = uvOf(0), *uv1 = uvOf(1), *uv2 = uvOf(2);
      state.TextureUV[0] = fused(uv0[0], w, fused(uv1[0], u, uv2[0] * v));
      state.TextureUV[1] = fused(uv0[1], w, fused(uv1[1], u, uv2[1] * v));
    }
    store(state.TextureUVW, load(state.HitPoint));
    if (needs & RTSL_NEEDS_DERIVATIVES)
      triangleDerivatives(state, p, uvOf(0), uvOf(1), uvOf(2));
  }
}

/// Runs a method that describes state's hit, with random numbers of its own.
template <typename Run>
void describeBy(PrimitiveMethod method, RtslState &state, Run run) {
  const uint32_t dimension = state.dimension;
  state.dimension = dimensionOf(method, state.instance, state.primitive);
  run();
  state.dimension = dimension;
}

/// The same for an RTSL primitive, using its methods. The ray of the state is in object space.
template <typename Slots>
void describePrimitive(RtslState &state, const RtslInstance &instance, uint32_t needs,
                       const Slots &slots) {
  const RtslRef primitive = instance.primitive;
  Vec3 origin = load(state.RayOrigin), direction = load(state.RayDirection);
  float t = state.HitDistance;
  store(state.HitPoint, {fused(t, direction.x, origin.x), fused(t, direction.y, origin.y),
                         fused(t, direction.z, origin.z)});
  state.hitPointError = primitivePointError(origin, direction, t);
  if (rtsl_needs(state.launch) & RTSL_NEEDS_CANDIDATE)
    describeBounds(state, instance, state.primitive);
  if (needs & RTSL_NEEDS_NORMALS) {
    setVector(state.GeometricNormal, 0, 0, 0);
    setVector(state.ShadingNormal, 0, 0, 0);
    describeBy(PrimitiveMethod::ComputeNormal, state,
               [&] { slots.rt_Primitive_computeNormal(&state, primitive); });
    // A normal that the author does not write equals the other one.
    if (isZero(load(state.ShadingNormal)))
      store(state.ShadingNormal, load(state.GeometricNormal));
    else if (isZero(load(state.GeometricNormal)))
      store(state.GeometricNormal, load(state.ShadingNormal));
  }
  if (needs & RTSL_NEEDS_HIT_ERRORS) {
    const Vec3 point = load(state.HitPoint), normal = load(state.GeometricNormal);
    const auto bound = [&](float error) {
      return primitivePointError(point, direction, error, normal);
    };
    if (isBound(state.hitError)) {
      state.hitPointError = bound(state.hitError);
    } else if (state.hitError == errorNotStated) {
      // The derived error is that of this test. The next one may be no better than assumed.
      const float error = derivedHitError(state, primitive, t, [&](RtslState *ray, RtslRef object) {
        slots.rt_Primitive_rt_boundHitError(ray, object);
      });
      if (isBound(error))
        state.hitPointError = maximum(state.hitPointError, bound(error));
    }
  }
  if (needs & RTSL_NEEDS_TEXTURE_COORDINATES)
    describeBy(PrimitiveMethod::ComputeTextureCoordinates, state,
               [&] { slots.rt_Primitive_computeTextureCoordinates(&state, primitive); });
  if (needs & RTSL_NEEDS_DERIVATIVES)
    describeBy(PrimitiveMethod::ComputeDerivatives, state,
               [&] { slots.rt_Primitive_computeDerivatives(&state, primitive); });
}

/// Texture coordinates and derivatives that nothing computes.
inline void clearCoordinates(RtslState &state, uint32_t needs) {
  if (needs & RTSL_NEEDS_TEXTURE_COORDINATES) {
    state.TextureUV[0] = state.TextureUV[1] = 0;
    setVector(state.TextureUVW, 0, 0, 0);
  }
  if (needs & RTSL_NEEDS_DERIVATIVES) {
    setVector(state.dPdu, 0, 0, 0);
    setVector(state.dPdv, 0, 0, 0);
    state.dsdu = state.dsdv = state.dtdu = state.dtdv = 0;
  }
}

/// Point, normals, coordinates and attributes of a mesh at state's hit, in world space.
inline void describeMeshHit(RtslState &state, const RtslInstance &instance, uint32_t needs) {
  const RtslLaunch &launch = *state.launch;
  const RtslMesh &mesh = launch.meshes[instance.mesh];
  const TriangleVertices p = verticesOfHit(state, mesh);
  describeTriangle(state, mesh, p, needs);
  if (const uint32_t applied = appliedTransform(instance);
      applied != 0 && needs & RTSL_NEEDS_TEXTURE_COORDINATES)
    store(state.TextureUVW, pointToObject(launch.transforms[applied], load(state.HitPoint)));
  if (needs & RTSL_NEEDS_ATTRIBUTES)
    describeAttributes(state, mesh);
  if (!isTransformed(launch, instance))
    return;
  const TransformAt transform(launch, instance, state.Time);
  surfaceToWorld(state, transform, needs, extents(p), 0);
  if (needs & RTSL_NEEDS_ATTRIBUTES)
    attributesToWorld(state, mesh, transform);
}

/// How u and v of state's hit on a mesh change along dPdx and dPdy.
inline BarycentricChanges barycentricChanges(const RtslState &state, const RtslMesh &mesh) {
  const TriangleVertices p = triangleVertices(*state.launch, mesh, state.primitive, state.Time);
  // In the space of the vertices.
  const bool isInWorld = !isTransformed(*state.launch, instanceAt(*state.launch, state.instance));
  BarycentricChanges by;
  solveForCoordinates(p.v1 - p.v0, p.v2 - p.v0, load(isInWorld ? state.dPdx : state.dUVWdx),
                      load(isInWorld ? state.dPdy : state.dUVWdy), by.along[0], by.along[1]);
  return by;
}

/// The changes of the shading normal of a mesh whose vertices have normals: those of the sum that
/// triangleNormals normalises.
inline void describeNormalChanges(RtslState &state, const RtslInstance &instance,
                                  const RtslMesh &mesh, const BarycentricChanges &by) {
  const RtslLaunch &launch = *state.launch;
  const uint32_t *index = mesh.indices + 3 * size_t(state.primitive);
  const auto normal = [&](int corner) {
    return vertexAt(launch, mesh, mesh.normals, index[corner], state.Time);
  };
  const Vec3 n0 = normal(0), n1 = normal(1), n2 = normal(2);
  const float u = state.u, v = state.v, w = (1.0f - u) - v;
  const Vec3 sum = n0 * w + n1 * u + n2 * v;
  const auto changed = [&](const float *along) {
    return changeOfNormalized(sum, (n1 - n0) * along[0] + (n2 - n0) * along[1]);
  };
  Vec3 x = changed(by.along[0]), y = changed(by.along[1]);
  if (isTransformed(launch, instance)) {
    const TransformAt transform(launch, instance, state.Time);
    const Vec3 world = covectorToWorld(launch, transform, normalized(sum));
    x = changeOfNormalized(world, covectorToWorld(launch, transform, x));
    y = changeOfNormalized(world, covectorToWorld(launch, transform, y));
  }
  store(state.dNdx, x);
  store(state.dNdy, y);
}

/// What changes across the footprint of state's hit on a mesh, beside what has derivatives of its
/// own: shading normals and attributes, which are interpolated between vertices.
inline void describeMeshChanges(RtslState &state, const RtslInstance &instance, uint32_t needs) {
  const RtslLaunch &launch = *state.launch;
  const RtslMesh &mesh = launch.meshes[instance.mesh];
  const bool ofNormals = needs & RTSL_NEEDS_NORMAL_CHANGES && mesh.normals;
  const bool ofAttributes = needs & RTSL_NEEDS_ATTRIBUTES && hasAttributeChanges(launch);
  if (!ofNormals && !ofAttributes)
    return;
  const BarycentricChanges by = barycentricChanges(state, mesh);
  if (ofNormals)
    describeNormalChanges(state, instance, mesh, by);
  if (!ofAttributes)
    return;
  describeAttributeChanges(state, mesh, by);
  if (isTransformed(launch, instance))
    attributeChangesToWorld(state, mesh, TransformAt(launch, instance, state.Time));
}

/// The same for an RTSL primitive.
template <typename Slots>
void describePrimitiveHit(RtslState &state, const RtslInstance &instance, uint32_t needs,
                          const Slots &slots) {
  const RtslLaunch &launch = *state.launch;
  {
    const InObjectSpace space(state, instance);
    describePrimitive(state, instance, needs, slots);
  }
  if (!isTransformed(launch, instance))
    return;
  const Vec3 point = load(state.HitPoint);
  surfaceToWorld(state, TransformAt(launch, instance, state.Time), needs,
                 {absolute(point.x), absolute(point.y), absolute(point.z)}, state.hitPointError);
}

/// The changes of scratch members across the footprint of state's hit on an RTSL primitive. Rays
/// through neighbouring points have other directions (language/Slots.def).
template <typename Slots>
void describePrimitiveChanges(RtslState &state, const RtslInstance &instance, const Slots &slots) {
  clearAttributeChanges(state);
  const float distance = state.HitDistance;
  const Vec3 x = load(state.dUVWdx), y = load(state.dUVWdy);
  {
    const InObjectSpace space(state, instance);
    state.HitDistance = infinity;
    const ModerateRay moderate(state);
    store(state.dUVWdx, x * (1 / distance) * moderate.factor());
    store(state.dUVWdy, y * (1 / distance) * moderate.factor());
    slots.rt_Primitive_rt_computeChanges(&state, instance.primitive);
  }
  state.HitDistance = distance;
  store(state.dUVWdx, x);
  store(state.dUVWdy, y);
}

/// Everything that a material may read of the hit, after traversal. `ofMaterial` is the set of what
/// it reads, `slots` has the methods of rt_Primitive, as members with the names of Slots.def. On
/// the host it is part of its callers, which know that set.
template <typename Slots>
#ifndef __NVPTX__
__attribute__((always_inline))
#endif
inline void describeHit(RtslState &state, uint32_t ofMaterial, const Slots &slots,
                        bool mayBeMesh = true) {
  const RtslLaunch &launch = *state.launch;
  const RtslInstance &instance = instanceAt(launch, state.instance);
  const uint32_t needs = withFootprint(ofMaterial);
  state.PrimitiveIndex = int32_t(state.primitive);
  state.InstanceIndex = int32_t(state.instance);
  if (needs & RTSL_NEEDS_INSTANCE_ID)
    state.InstanceId = instance.id;
  clearCoordinates(state, needs);
  if (needs & RTSL_NEEDS_TRANSFORMS)
    describeTransforms(state, instance);
  const bool isMesh = mayBeMesh && instance.primitive == 0;
  if (isMesh)
    describeMeshHit(state, instance, needs);
  else
    describePrimitiveHit(state, instance, needs, slots);
  if (rtsl_needs(&launch) & RTSL_NEEDS_FOOTPRINT) // rays that leave the hit have a cone in any case
    state.ConeWidth = coneWidthAtHit(state);
  if (!(needs & RTSL_NEEDS_FOOTPRINT))
    return;
  describeFootprint(state, instance, needs);
  if (isMesh)
    describeMeshChanges(state, instance, needs);
  else if (needs & RTSL_NEEDS_ATTRIBUTES)
    describePrimitiveChanges(state, instance, slots);
}

inline void describeHit(RtslState &state) {
  const RtslLaunch &launch = *state.launch;
  uint32_t needs = instanceAt(launch, state.instance).needs & rtsl_needs(&launch);
  describeHit(state, needs, LinkedSlots());
}

/// The same for a surface that no ray leaves: without the error of the point. `mayBeMesh`: false if
/// it is known to be a primitive.
inline void describeHitAtEnd(RtslState &state, bool mayBeMesh) {
  const RtslLaunch &launch = *state.launch;
  uint32_t needs = instanceAt(launch, state.instance).needs & rtsl_needs(&launch);
  describeHit(state, needs & ~RTSL_NEEDS_HIT_ERRORS, LinkedSlots(), mayBeMesh);
}

} // namespace rtsl::device
