//===- EmbreeRay.h - one ray through Embree -------------------------------===//
//
// Inline, because it is the hottest code of the host: rtsl_traverse combines it into one function,
// from the ray's state to Embree's and back.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/accel/TriangleBlocks.h"
#include "runtime/device/ray/Hit.h"
#include "runtime/device/traverse/Traverse.h"
#include "runtime/embree/EmbreeScene.h"
#include "runtime/embree/LastOccluders.h"

#include <embree3/rtcore.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace rtsl::runtime {

/// Embree's context of a ray, followed by the data for our callbacks.
struct EmbreeContext {
  RTCIntersectContext embree;
  RtslState *state;
  const device::TriangleRay *ray;
  const EmbreeScene::Implementation *scene;
  const EmbreeVisitor *visitor; // null: candidates are tested, and committed if they win
  float toEmbree;               // a power of two that turns our t into Embree's
  // for a ray that needs any hit only: the block in which one was found
  mutable std::uint32_t occluder;

  static constexpr std::uint32_t noBlock = ~0u;

  /// Where Embree's search may end, if hits beyond t do not matter.
  float end(float t) const { return t * toEmbree * device::cullSlack; }
};

/// An RTSL primitive in Embree.
struct EmbreePrimitive {
  void (*intersect)(RtslState *, RtslRef);
  RtslRef object;
  std::uint32_t instance;
};

/// A tree for rays with origins up to some distance.
struct EmbreeLevel {
  const EmbreeScene::Implementation *owner = nullptr;
  float largestOrigin = 0; // the sum of its coordinates
  RTCScene scene = nullptr;
  std::once_flag built;
};

struct EmbreeScene::Implementation {
  std::uint64_t number = 0; // unique in the process; from 1
  RTCDevice device = nullptr;
  const RtslInstance *instances = nullptr;
  LargeArray<TriangleBlock> blocks;
  std::vector<EmbreePrimitive> primitives;
  void (*intersect)(RtslState *, RtslRef) = nullptr; // of any class
  // by largestOrigin; the first one is built
  mutable std::vector<std::unique_ptr<EmbreeLevel>> levels;
  RTCError error = RTC_ERROR_NONE;
  std::string errorText;

  Implementation() = default;
  Implementation(const Implementation &) = delete;
  ~Implementation();

  /// The tree for rays from this origin.
  RTCScene treeFor(const float *origin) const {
    float size =
        __builtin_fabsf(origin[0]) + __builtin_fabsf(origin[1]) + __builtin_fabsf(origin[2]);
    return size <= levels[0]->largestOrigin ? levels[0]->scene : treeForFar(size);
  }
  RTCScene treeForFar(float origin) const;

  /// Fills Embree's ray from the state. With factors of 1 the values are copied.
  static void fill(RTCRay &ray, const RtslState &state, float toEmbree, float fromEmbree,
                   float end) {
    std::memcpy(&ray.org_x, state.RayOrigin, sizeof state.RayOrigin);
    if (fromEmbree == 1) {
      std::memcpy(&ray.dir_x, state.RayDirection, sizeof state.RayDirection);
    } else {
      ray.dir_x = state.RayDirection[0] * fromEmbree;
      ray.dir_y = state.RayDirection[1] * fromEmbree;
      ray.dir_z = state.RayDirection[2] * fromEmbree;
    }
    ray.tnear = device::maximum(state.Epsilon * toEmbree, 0.0f) * (1.0f - 2 * device::rangeShare);
    ray.tfar = end;
    ray.time = 0;
    ray.mask = ~0u;
    ray.id = 0;
    ray.flags = 0;
  }

  /// `toEmbree` and `fromEmbree` are powers of two that convert our t to Embree's, and back.
  [[gnu::always_inline]] std::uint32_t query(RtslState &state, bool anyHit, float toEmbree,
                                             float fromEmbree) const {
    const device::TriangleRay triangleRay =
        device::makeTriangleRay(device::load(state.RayOrigin), device::load(state.RayDirection));
    device::beginSearch(state);
    EmbreeContext context;
    rtcInitIntersectContext(&context.embree);
    context.state = &state;
    context.ray = &triangleRay;
    context.scene = this;
    context.visitor = nullptr;
    context.toEmbree = toEmbree;
    const RTCScene tree = treeFor(state.RayOrigin);
    if (anyHit) {
      LastOccluders &last = LastOccluders::towards(state.RayDirection);
      const auto meets = [&](std::uint32_t block) {
        return testBlock(state, triangleRay, blocks[block], true);
      };
      if (last.isMet(number, meets))
        return device::endSearch(state);
      context.occluder = EmbreeContext::noBlock;
      RTCRay ray;
      fill(ray, state, toEmbree, fromEmbree, context.end(state.HitDistance));
      rtcOccluded1(tree, &context.embree, &ray);
      if (context.occluder != EmbreeContext::noBlock)
        last.learn(number, context.occluder);
    } else {
      RTCRayHit rayHit;
      fill(rayHit.ray, state, toEmbree, fromEmbree, context.end(state.HitDistance));
      rayHit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      rayHit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
      rtcIntersect1(tree, &context.embree, &rayHit);
      device::findLostAttributes(state, triangleRay, intersect);
    }
    return device::endSearch(state);
  }
};

[[gnu::always_inline]] inline std::uint32_t EmbreeScene::traverseEasy(RtslState &state,
                                                                      bool anyHit) const {
  return self->query(state, anyHit, 1, 1);
}

} // namespace rtsl::runtime
