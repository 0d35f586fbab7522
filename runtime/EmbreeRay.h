//===- EmbreeRay.h - one ray through Embree -------------------------------===//
//
// Inline, for it is the hottest code of the host: rtsl_traverse makes of it one function, from the
// ray's state to Embree's and back.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/EmbreeScene.h"
#include "runtime/device/Hit.h"
#include "runtime/device/Traverse.h"

#include <embree3/rtcore.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace rtsl::runtime {

/// Embree's context of a ray, and behind it what our callbacks need.
struct EmbreeContext {
  RTCIntersectContext embree;
  RtslState *state;
  float toEmbree, fromEmbree; // powers of two that turn our t into Embree's, and back
};

/// An RTSL primitive in Embree.
struct EmbreePrimitive {
  void (*intersect)(RtslState *, RtslRef);
  RtslRef object;
  std::uint32_t instance;
  Bounds bounds;
};

struct EmbreeScene::Implementation {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  const RtslMesh *meshes = nullptr;
  const RtslInstance *instances = nullptr;
  std::vector<EmbreePrimitive> primitives; // by instance; Embree holds pointers into it
  RTCError error = RTC_ERROR_NONE;
  std::string errorText;

  Implementation() = default;
  Implementation(const Implementation &) = delete;
  ~Implementation();

  /// Embree's ray of the state's. What a factor of 1 multiplies is copied.
  static void fill(RTCRay &ray, const RtslState &state, float toEmbree, float fromEmbree) {
    std::memcpy(&ray.org_x, state.RayOrigin, sizeof state.RayOrigin);
    if (fromEmbree == 1) {
      std::memcpy(&ray.dir_x, state.RayDirection, sizeof state.RayDirection);
    } else {
      ray.dir_x = state.RayDirection[0] * fromEmbree;
      ray.dir_y = state.RayDirection[1] * fromEmbree;
      ray.dir_z = state.RayDirection[2] * fromEmbree;
    }
    ray.tnear = device::maximum(state.Epsilon * toEmbree, 0.0f);
    ray.tfar = state.HitDistance * toEmbree;
    ray.time = 0;
    ray.mask = ~0u;
    ray.id = 0;
    ray.flags = 0;
  }

  /// `toEmbree` and `fromEmbree` are powers of two and turn our t into Embree's, and back.
  [[gnu::always_inline]] EmbreeAnswer query(RtslState &state, bool anyHit, float toEmbree,
                                            float fromEmbree) const {
    EmbreeContext context;
    rtcInitIntersectContext(&context.embree);
    context.state = &state;
    context.toEmbree = toEmbree;
    context.fromEmbree = fromEmbree;
    if (anyHit) {
      RTCRay ray;
      fill(ray, state, toEmbree, fromEmbree);
      rtcOccluded1(scene, &context.embree, &ray);
      return ray.tfar < 0 ? EmbreeAnswer::Hit : EmbreeAnswer::Miss;
    }

    const float distance = state.HitDistance;
    RTCRayHit rayHit;
    fill(rayHit.ray, state, toEmbree, fromEmbree);
    rayHit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rayHit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene, &context.embree, &rayHit);
    const std::uint32_t instance = rayHit.hit.geomID;
    if (instance == RTC_INVALID_GEOMETRY_ID)
      return EmbreeAnswer::Miss;
    if (instances[instance].primitive != 0)
      return EmbreeAnswer::Hit; // its `intersect` has committed it
    return checkTriangle(state, instance, rayHit.hit.primID, distance);
  }

  /// Of a triangle only the name is taken from Embree. `distance` is where the ray ends.
  EmbreeAnswer checkTriangle(RtslState &state, std::uint32_t instance, std::uint32_t triangle,
                             float distance) const {
    using namespace device;
    state.HitDistance = distance;
    state.instance = RTSL_NO_HIT;
    const TriangleRay ray = makeTriangleRay(load(state.RayOrigin), load(state.RayDirection));
    return testTriangle(state, ray, meshes[instances[instance].mesh], instance, triangle)
               ? EmbreeAnswer::Hit
               : EmbreeAnswer::Refused;
  }
};

[[gnu::always_inline]] inline EmbreeAnswer EmbreeScene::traverseEasy(RtslState &state,
                                                                     bool anyHit) const {
  return self->query(state, anyHit, 1, 1);
}

} // namespace rtsl::runtime
