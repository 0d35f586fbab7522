//===- Traverse.h - the device traversal: tree, triangles, RTSL primitives ===//
#pragma once

#include "runtime/device/Abi.h"
#include "runtime/device/Bvh.h"
#include "runtime/device/Candidate.h"
#include "runtime/device/Hit.h"
#include "runtime/device/Triangle.h"
#include "runtime/device/Vector.h"

namespace rtsl::device {

/// A ray that can be followed: all finite, and a direction.
inline bool isGoodRay(const RtslState &state) {
  if (state.isEasy)
    return true;
  Vec3 direction = load(state.RayDirection);
  return isFinite(load(state.RayOrigin)) && isFinite(direction) && !isZero(direction) &&
         state.Epsilon == state.Epsilon && state.HitDistance == state.HitDistance;
}

/// Is the instance there for the ray at all?
inline bool isSeen(const RtslState &state, const RtslInstance &instance) {
  return state.rayRoot == 0 && (instance.mask & state.rayMask);
}

struct TriangleVertices {
  Vec3 v0, v1, v2;
};

inline TriangleVertices triangleVertices(const RtslMesh &mesh, uint32_t triangle) {
  const uint32_t *index = mesh.indices + 3 * size_t(triangle);
  return {load(mesh.positions + 3 * size_t(index[0])), load(mesh.positions + 3 * size_t(index[1])),
          load(mesh.positions + 3 * size_t(index[2]))};
}

/// Tests one triangle and commits it if it wins.
inline bool testTriangle(RtslState &state, const TriangleRay &ray, const RtslMesh &mesh,
                         uint32_t instance, uint32_t triangle) {
  TriangleVertices vertices = triangleVertices(mesh, triangle);
  TriangleHit hit;
  if (!intersectTriangle(ray, vertices.v0, vertices.v1, vertices.v2, hit))
    return false;
  if (!wins(state, hit.t, instance, triangle))
    return false;
  state.HitDistance = hit.t;
  state.instance = instance;
  state.primitive = triangle;
  state.u = hit.u;
  state.v = hit.v;
  return true;
}

/// rtsl_traverse by our own tree. intersect(state, object) is the slot of rt_Primitive.
template <typename Intersect>
uint32_t traverseDevice(RtslState &state, bool anyHit, Intersect intersect) {
  if (!isGoodRay(state))
    return RTSL_BAD_RAY;
  const RtslLaunch &launch = *state.launch;
  TriangleRay ray = makeTriangleRay(load(state.RayOrigin), load(state.RayDirection));
  Vec3 direction = load(state.RayDirection);
  Vec3 inverse = {1.0f / direction.x, 1.0f / direction.y, 1.0f / direction.z};
  bool stopped = traverseBvh(
      launch, load(state.RayOrigin), inverse, maximum(state.Epsilon, 0.0f),
      [&] { return state.HitDistance; },
      [&](const RtslLeafItem &item) {
        const RtslInstance &instance = launch.instances[item.instance];
        if (!isSeen(state, instance))
          return false;
        if (instance.primitive == 0) {
          bool found =
              testTriangle(state, ray, launch.meshes[instance.mesh], item.instance, item.primitive);
          return found && anyHit;
        }
        beginCandidate(state, item.instance, item.primitive);
        intersect(&state, instance.primitive);
        return anyHit && state.instance != RTSL_NO_HIT;
      });
  return stopped || state.instance != RTSL_NO_HIT ? RTSL_HIT : RTSL_MISS;
}

} // namespace rtsl::device
