//===- Programs.h - the programs engine: rays with a payload --------------===//
//
// A sample is what `generate` of the scene's ray generation writes to SampleColor. The rays that it
// sends carry a struct of the author's, the payload, whose type selects the methods that handle
// them: the `closestHit` of the material that is hit, the `miss` of the background, and during
// traversal `anyHit` of every material that could be hit (AnyHit.h). A ray without a payload is
// handled by the classic engine, at any depth, and vice versa.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/engines/Classic.h"
#include "runtime/device/ray/Abi.h"

namespace rtsl::device {

/// The arguments of `trace` with a payload.
struct PayloadRay {
  Vec3 origin, direction;
  float tmin, tmax;
  void *payload;
  int32_t root;
  uint32_t mask;
  float time;
  uint32_t rayType;
};

/// Makes `child` the ray that `parent` sends; they may be the same. It ignores hits nearer than the
/// rounding error of its origin, whatever tmin is.
inline void spawn(RtslState &child, const RtslState &parent, uint32_t dimension,
                  const PayloadRay &ray) {
  beginChild(child, parent, [&](const RtslState &from) {
    descend(child, from, dimension);
    child.Time = ray.time;
    child.payload = ray.payload;
    child.rayType = ray.rayType;
    child.rayMask = ray.mask;
    child.rayRoot = ray.root;
    RayStart start = startOf(from, ray.origin, ray.direction);
    if (!(ray.tmin == ray.tmin && ray.tmax == ray.tmax)) // one of them is NaN
      start.isEasy = 0;
    if (!(ray.tmin < start.epsilon))
      start.epsilon = ray.tmin;
    setRay(child, ray.origin, ray.direction, start, ray.tmax,
           passedDistance(from, ray.origin, ray.direction));
  });
}

/// Describes the result of traversing state's ray, for the methods for its payload.
inline Arrival arriveWithPayloadAt(RtslState &state, uint32_t how, uint32_t found) {
  const RtslLaunch &launch = *state.launch;
  if (found == RTSL_HIT) {
    RtslRef material = instanceAt(launch, state.instance).material;
    if (!(how & RTSL_FIRST_HIT)) { // otherwise no method reads it
      describeHit(state);
      describeEmitter(state);
    }
    return {Arrival::Surface, material};
  }
  if (found == RTSL_BAD_RAY)
    raise(state, RTSL_EXCEPTION_BAD_RAY);
  if (found == RTSL_MISS && launch.background)
    return arriveAtBackground(state);
  return {Arrival::Nothing, 0};
}

/// Traverses state's ray and describes the result, for the methods for its payload.
inline Arrival arriveWithPayload(RtslState &state, uint32_t how) {
  return arriveWithPayloadAt(state, how, traverseWithDefaults(state, how));
}

/// `trace` with a payload. Deeper than the launch allows, the payload is unchanged.
inline void trace(RtslState &parent, const PayloadRay &ray, uint32_t how) {
  uint32_t dimension;
  if (!maySpawn(parent, &dimension))
    return;
  RtslState state;
  spawn(state, parent, dimension, ray);
  Arrival arrival = arriveWithPayload(state, how);
  if (arrival.kind == Arrival::Surface)
    rtsl_rt_Material_closestHit_payload(&state, arrival.object);
  else if (arrival.kind == Arrival::Background)
    rtsl_rt_Miss_miss_payload(&state, arrival.object);
}

/// Makes `state` that of `generate`, which precedes all rays: the rays that it sends have depth 0.
/// Its own ray is the camera's, if the scene has one. False if `generate` reads that ray and the
/// camera sends none: the sample is black.
inline bool startGenerate(RtslState &state, const RtslLaunch &launch, uint32_t x, uint32_t y,
                          uint32_t index, RtslEvents &events) {
  placeSample(state, launch, x, y, index, events);
  state.Depth = -1;
  state.instance = RTSL_NO_HIT;
  setColor(state.SampleColor, rtsl_color_components(&launch), 0);
  state.ConeWidth = state.ConeSpread = 0;
  if (!(rtsl_needs(&launch) & RTSL_NEEDS_CAMERA_RAY))
    return true;
  if (launch.camera)
    return aimCamera(state, launch);
  setVector(state.RayOrigin, 0, 0, 0);
  setVector(state.RayDirection, 0, 0, 0);
  return true;
}

/// One sample of one pixel: the result of `generate`.
inline void generate(const RtslLaunch &launch, uint32_t x, uint32_t y, uint32_t index,
                     float *color) {
  RtslState state;
  RtslEvents events;
  if (startGenerate(state, launch, x, y, index, events))
    rtsl_rt_RayGeneration_generate(&state, launch.rayGeneration);
  endEvents(state);
  copyColor(color, state.SampleColor, rtsl_color_components(&launch));
}

} // namespace rtsl::device
