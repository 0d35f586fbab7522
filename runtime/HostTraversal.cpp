//===- HostTraversal.cpp - rtsl_traverse on the host ----------------------===//
#include "runtime/HostScene.h"

#include "runtime/EmbreeRay.h"
#include "runtime/device/AnyHit.h"

namespace rtsl::runtime {

RayCounters &rayCounters() {
  static thread_local RayCounters counters;
  return counters;
}

HostScene::HostScene(const Scene &scene, bool useEmbree, unsigned threads)
    : ProgramHost{scene.program().slots}, scene(scene) {
  if (useEmbree)
    embree = std::make_unique<EmbreeScene>(scene, slots, threads);
  else
    deviceLaunch();
}

const RtslLaunch &HostScene::deviceLaunch() const {
  std::call_once(built, [this] {
    bvh = buildBvh(scene);
    launch = scene.launch();
    launch.host = this;
    bvh.install(launch);
  });
  return launch;
}

std::uint32_t HostScene::traverseCarefully(RtslState &state, bool anyHit) const {
  if (!device::isGoodRay(state)) {
    ++rayCounters().badRays;
    return RTSL_BAD_RAY;
  }
  if (!embree)
    return device::traverseDevice(state, anyHit, slots.rt_Primitive_intersect);
  float distance = state.HitDistance;
  EmbreeAnswer answer = embree->traverse(state, anyHit);
  if (answer == EmbreeAnswer::Refused)
    return retrace(state, anyHit, distance);
  return answer == EmbreeAnswer::Hit ? RTSL_HIT : RTSL_MISS;
}

std::uint32_t HostScene::retrace(RtslState &state, bool anyHit, float distance) const {
  ++rayCounters().retracedRays;
  state.HitDistance = distance;
  state.instance = state.primitive = RTSL_NO_HIT;
  return withNodes(
      state, [&] { return device::traverseDevice(state, anyHit, slots.rt_Primitive_intersect); });
}

/// Runs `work` on a launch that has our tree: the ray's may not have any.
template <typename Work>
std::uint32_t HostScene::withNodes(RtslState &state, Work work) const {
  const RtslLaunch *given = state.launch;
  if (given->nodeCount != 0)
    return work();
  deviceLaunch();
  RtslLaunch withNodes = *given;
  bvh.install(withNodes);
  state.launch = &withNodes;
  std::uint32_t answer = work();
  state.launch = given;
  return answer;
}

/// Rays whose hits may be refused, and those for which some instances are not there: for Embree
/// they would be strangers too, for it gives hits in its own order.
std::uint32_t HostScene::traverseOurselves(RtslState &state, std::uint32_t how) const {
  std::uint32_t answer = withNodes(state, [&] {
    return how & RTSL_ASK_ANY_HIT
               ? device::traverseAsking(state, how, FilledSlots{slots})
               : device::traverseDevice(state, how & RTSL_FIRST_HIT, slots.rt_Primitive_intersect);
  });
  rayCounters().badRays += answer == RTSL_BAD_RAY;
  return answer;
}

[[gnu::always_inline]] inline std::uint32_t HostScene::traverseFast(RtslState &state,
                                                                    std::uint32_t how) const {
  if (how & RTSL_ASK_ANY_HIT || state.rayMask != ~0u || state.rayRoot != 0)
    return traverseOurselves(state, how);
  bool anyHit = how & RTSL_FIRST_HIT;
  if (!embree || !EmbreeScene::isEasy(state))
    return traverseCarefully(state, anyHit);
  float distance = state.HitDistance;
  EmbreeAnswer answer = embree->traverseEasy(state, anyHit);
  if (answer == EmbreeAnswer::Refused)
    return retrace(state, anyHit, distance);
  return answer == EmbreeAnswer::Hit ? RTSL_HIT : RTSL_MISS;
}

std::uint32_t HostScene::traverse(RtslState &state, std::uint32_t how) const {
  return traverseFast(state, how);
}

} // namespace rtsl::runtime

extern "C" std::uint32_t rtsl_traverse(RtslState *state, std::uint32_t how) {
  return static_cast<const rtsl::runtime::HostScene *>(state->launch->host)
      ->traverseFast(*state, how);
}
