//===- EmbreeRay.h - one ray through Embree -------------------------------===//
//
// Inline, because it is the hottest code of the host: rtsl_traverse combines it into one function,
// from the ray's state to Embree's and back.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/accel/TreeContents.h"
#include "runtime/device/ray/Hit.h"
#include "runtime/device/traverse/Traverse.h"
#include "runtime/embree/EmbreeScene.h"
#include "runtime/embree/EmbreeSpace.h"
#include "runtime/embree/EnterSpace.h"
#include "runtime/embree/LastHit.h"
#include "runtime/embree/LastOccluders.h"

#include <embree3/rtcore.h>

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace rtsl::runtime {

/// Embree's context of a ray, followed by the data for our callbacks.
struct EmbreeContext {
  RTCIntersectContext embree;
  RtslState *state;
  const device::TriangleRay *ray; // in `space`; an InstanceRay if that is not the world
  const EmbreeSpace *space;
  const EmbreeVisitor *visitor; // null: candidates are tested, and committed if they win
  bool seesAll;                 // the ray sees all instances
  bool endsIfHidden;            // the search is device::towardsPoint
  float toEmbree;               // a power of two that turns our t into Embree's
  // what was hit, if any hit was sufficient, or hides the point that the ray goes towards
  mutable Occluder occluder;
  Occluder tested;        // before the search, in the world
  mutable Occluder found; // what has won so far, in the world

  /// Where Embree's search may end, if hits beyond t do not matter.
  float end(float t) const { return t * toEmbree * device::cullSlack; }
  /// Hits beyond it do not matter.
  float limit() const { return visitor ? visitor->limit(visitor->self) : state->nearest; }
};

struct EmbreeScene::Implementation {
  std::uint64_t number = 0; // unique in the process; from 1
  RTCDevice device = nullptr;
  EmbreeSpace world;
  std::map<std::uint32_t, std::unique_ptr<EmbreeSpace>> spaces; // by device::treeNumber
  const Program::Slots *slots = nullptr;
  RtslLaunch launch{};
  std::vector<InstanceContents> contents;
  RTCError error = RTC_ERROR_NONE;
  std::string errorText;

  Implementation() = default;
  Implementation(const Implementation &) = delete;
  ~Implementation();

  /// Fills Embree's ray. With factors of 1 the values are copied.
  static void fill(RTCRay &ray, const device::TriangleRay &from, float epsilon, float toEmbree,
                   float fromEmbree, float end) {
    ray.org_x = from.origin.x;
    ray.org_y = from.origin.y;
    ray.org_z = from.origin.z;
    const bool isScaled = fromEmbree != 1;
    ray.dir_x = isScaled ? from.direction.x * fromEmbree : from.direction.x;
    ray.dir_y = isScaled ? from.direction.y * fromEmbree : from.direction.y;
    ray.dir_z = isScaled ? from.direction.z * fromEmbree : from.direction.z;
    ray.tnear = device::maximum(epsilon * toEmbree, 0.0f) * (1.0f - 2 * device::rangeShare);
    ray.tfar = end;
    ray.time = 0;
    ray.mask = ~0u;
    ray.id = 0;
    ray.flags = 0;
  }

  /// Does the ray of the context hit anything in one of the world's instances?
  static bool isInInstance(const EmbreeContext &context, std::uint32_t number);
  /// Searches one of them for the nearest hit.
  static void searchInInstance(const EmbreeContext &context, std::uint32_t number);

  /// Searches the items of the world's list (ItemList.h). True if the search is over.
  static bool searchList(const EmbreeContext &context, bool anyHit);

  /// Tests what the last camera ray has hit.
  [[gnu::always_inline]] void testLastHit(EmbreeContext &context) const {
    RtslState &state = *context.state;
    const Occluder first = LastHit::ofThread().toTest(number);
    if (first.number == Occluder::none)
      return;
    if (first.isInstance)
      searchInInstance(context, first.number);
    else
      testBlock(state, *context.ray, world.blocks[first.number], false);
    context.tested = first;
    if (state.nearest < state.HitDistance)
      context.found = first;
  }

  /// `toEmbree` and `fromEmbree` are powers of two that convert our t to Embree's, and back.
  [[gnu::always_inline]] std::uint32_t query(RtslState &state, std::uint32_t how, float toEmbree,
                                             float fromEmbree) const {
    device::TriangleRay triangleRay;
    makeRay(state.RayOrigin, state.RayDirection, triangleRay);
    device::beginSearch(state);
    EmbreeContext context;
    rtcInitIntersectContext(&context.embree);
    context.state = &state;
    context.ray = &triangleRay;
    context.space = &world;
    context.visitor = nullptr;
    context.seesAll = true;
    context.endsIfHidden = how & device::towardsPoint;
    context.toEmbree = toEmbree;
    const RTCScene tree = world.treeFor(device::load(state.RayOrigin));
    const bool anyHit = how & RTSL_FIRST_HIT;
    LastOccluders &last = LastOccluders::towards(state.RayDirection);
    if (anyHit || context.endsIfHidden) {
      const auto meets = [&](const Occluder &occluder) {
        const bool isHit = occluder.isInstance
                               ? isInInstance(context, occluder.number)
                               : testBlock(state, triangleRay, world.blocks[occluder.number], true);
        return isHit && device::endsWithHit(state, how);
      };
      if (last.isMet(number, meets))
        return device::endSearch(state);
    }
    const bool isFromCamera = !anyHit && state.leaves == RTSL_NO_HIT && !context.endsIfHidden;
    if (isFromCamera)
      testLastHit(context);
    const bool isOver = !world.list.isEmpty() && searchList(context, anyHit);
    if (isOver || world.isTreeEmpty()) {
      // no search of the tree
    } else if (anyHit) {
      RTCRay ray;
      fill(ray, triangleRay, state.Epsilon, toEmbree, fromEmbree, context.end(state.HitDistance));
      rtcOccluded1(tree, &context.embree, &ray);
    } else {
      RTCRayHit rayHit;
      fill(rayHit.ray, triangleRay, state.Epsilon, toEmbree, fromEmbree,
           context.end(state.nearest));
      rayHit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      rayHit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
      rtcIntersect1(tree, &context.embree, &rayHit);
    }
    if (isFromCamera)
      LastHit::ofThread().learn(number, context.found);
    if (!anyHit)
      device::findLostAttributes(state, triangleRay, slots->rt_Primitive_intersect);
    if (context.occluder.number != Occluder::none)
      last.learn(number, context.occluder);
    return device::endSearch(state);
  }
};

[[gnu::always_inline]] inline std::uint32_t EmbreeScene::traverseEasy(RtslState &state,
                                                                      std::uint32_t how) const {
  return self->query(state, how, 1, 1);
}

} // namespace rtsl::runtime
