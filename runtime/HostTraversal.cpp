//===- HostTraversal.cpp - rtsl_traverse on the host ----------------------===//
#include "runtime/HostScene.h"

#include "runtime/device/Traverse.h"

namespace rtsl::runtime {

RayCounters &rayCounters() {
  static thread_local RayCounters counters;
  return counters;
}

HostScene::HostScene(const Scene &scene, bool useEmbree, unsigned threads)
    : scene(scene), slots(scene.program().slots) {
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
  // The nodes are in a launch of our own: the ray's may not have any.
  const RtslLaunch *given = state.launch;
  deviceLaunch();
  RtslLaunch withNodes = *given;
  bvh.install(withNodes);
  state.launch = &withNodes;
  state.HitDistance = distance;
  state.instance = state.primitive = RTSL_NO_HIT;
  std::uint32_t answer = device::traverseDevice(state, anyHit, slots.rt_Primitive_intersect);
  state.launch = given;
  return answer;
}

} // namespace rtsl::runtime

extern "C" std::uint32_t rtsl_traverse(RtslState *state, std::uint32_t anyHit) {
  return static_cast<const rtsl::runtime::HostScene *>(state->launch->host)
      ->traverse(*state, anyHit != 0);
}
