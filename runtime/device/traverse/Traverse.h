//===- Traverse.h - the device traversal ----------------------------------===//
#pragma once

#include "runtime/device/traverse/LaunchTree.h"
#include "runtime/device/traverse/ModerateRay.h"
#include "runtime/device/traverse/TestItem.h"

namespace rtsl::device {

/// rtsl_traverse without `anyHit`, with any tree. `slots` has the methods that it needs as members
/// with the names of Slots.def.
template <typename Slots, typename Tree>
uint32_t findHit(RtslState &state, uint32_t how, const Slots &slots, const Tree &tree) {
  const ModerateSearch moderate(state, how);
  if (!moderate.isGood())
    return RTSL_BAD_RAY;
  TriangleRay ray = makeTriangleRay(load(state.RayOrigin), load(state.RayDirection));
  const auto intersect = withModerateRay(
      [&](RtslState *ray, RtslRef object) { slots.rt_Primitive_intersect(ray, object); },
      scalesWholeSearch(*state.launch));
  beginSearch(state);
  tree.forEach(
      state, ray, [&] { return state.nearest; },
      [&](const RtslInstance &instance) { return isSeen(state, instance, slots); },
      [&](const auto &item, const auto &inItsSpace) {
        return testIfSeen(state, inItsSpace, item, slots, intersect) && endsWithHit(state, how);
      });
  if (!(how & RTSL_FIRST_HIT))
    findLostAttributes(state, ray, intersect);
  return endSearch(state);
}

/// rtsl_traverse with the tree of the launch.
template <typename Slots>
uint32_t traverseDevice(RtslState &state, uint32_t how, const Slots &slots) {
  // A ray that ends at its first hit gains more from an early one.
  return findHit(state, how, slots, LaunchTree{!(how & RTSL_FIRST_HIT), /*testsAll=*/true});
}

} // namespace rtsl::device
