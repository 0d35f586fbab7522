//===- EmbreeRay.h - one ray through Embree -------------------------------===//
//
// Inline, because it is the hottest code of the host: rtsl_traverse combines it into one function,
// from the ray's state to Embree's and back.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/accel/TreeContents.h"
#include "runtime/device/ray/Hit.h"
#include "runtime/device/traverse/TestItem.h"
#include "runtime/embree/EmbreeContext.h"
#include "runtime/embree/EnterSpace.h"
#include "runtime/embree/LastHit.h"
#include "runtime/embree/LastOccluders.h"
#include "runtime/embree/SearchTriangles.h"

#include <embree3/rtcore.h>

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace rtsl::runtime {

struct EmbreeScene::Implementation {
  std::uint64_t number = 0; // unique in the process; from 1
  RTCDevice device = nullptr;
  EmbreeSpace world;
  std::map<std::uint32_t, std::unique_ptr<EmbreeSpace>> spaces; // by device::treeNumber
  const Program::Slots *slots = nullptr;
  RtslLaunch launch{};
  bool scalesSearches = false; // device::scalesWholeSearch(launch)
  std::vector<InstanceContents> contents;
  RTCError error = RTC_ERROR_NONE;
  std::string errorText;

  Implementation() = default;
  Implementation(const Implementation &) = delete;
  ~Implementation();

  void setLaunch(const RtslLaunch &other) {
    launch = other;
    scalesSearches = device::scalesWholeSearch(launch);
  }

  /// Does the ray of the context hit anything in one of the world's instances?
  static bool isInInstance(const EmbreeContext &context, std::uint32_t number);
  /// Searches one of them for the nearest hit.
  static void searchInInstance(const EmbreeContext &context, std::uint32_t number);

  /// Searches the items of the world's list (ItemList.h). True if the search is over.
  static bool searchList(const EmbreeContext &context, bool anyHit);

  /// Searches Embree's tree of the space, if it has one. True if the search is over.
  static bool searchTree(const EmbreeContext &context, bool anyHit);

  /// Tests what the last camera ray has hit.
  [[gnu::always_inline]] void testLastHit(EmbreeContext &context) const {
    RtslState &state = *context.state;
    const Occluder first = LastHit::ofThread().toTest(number);
    if (first.number == Occluder::none)
      return;
    if (first.isInstance)
      searchInInstance(context, first.number);
    else
      testBlock(state, *context.ray, world.triangles.block(first.number), false);
    context.tested = first;
    if (state.nearest < state.HitDistance)
      context.found = first;
  }

  /// `toEmbree` is a power of two that converts our t to Embree's.
  [[gnu::always_inline]] std::uint32_t query(RtslState &state, std::uint32_t how,
                                             float toEmbree) const {
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
    const bool anyHit = how & RTSL_FIRST_HIT;
    LastOccluders &last = LastOccluders::towards(state.RayDirection);
    if (anyHit || context.endsIfHidden) {
      const auto meets = [&](const Occluder &occluder) {
        const bool isHit =
            occluder.isInstance
                ? isInInstance(context, occluder.number)
                : testBlock(state, triangleRay, world.triangles.block(occluder.number), true);
        return isHit && device::endsWithHit(state, how);
      };
      if (last.isMet(number, meets))
        return device::endSearch(state);
    }
    const bool isFromCamera = !anyHit && state.leaves == RTSL_NO_HIT && !context.endsIfHidden;
    if (isFromCamera)
      testLastHit(context);
    const bool isOver = (!world.list.isEmpty() && searchList(context, anyHit)) ||
                        searchTriangles<device::TriangleRay>(context, anyHit);
    if (!isOver && world.hasTree())
      searchTree(context, anyHit);
    if (isFromCamera)
      LastHit::ofThread().learn(number, context.found);
    if (!anyHit && state.areAttributesLost)
      device::findLostAttributes(
          state, triangleRay,
          device::withModerateRay(slots->rt_Primitive_intersect, scalesSearches));
    if (context.occluder.number != Occluder::none)
      last.learn(number, context.occluder);
    return device::endSearch(state);
  }
};

[[gnu::always_inline]] inline std::uint32_t EmbreeScene::traverseEasy(RtslState &state,
                                                                      std::uint32_t how) const {
  return self->query(state, how, 1);
}

} // namespace rtsl::runtime
