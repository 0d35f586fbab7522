//===- Classic.h - the classic engine: camera, trace, shade, light --------===//
//
// A ray's color is what `shade` of the material that it hits writes to SampleColor, or the
// background's. A shader traces other rays with `trace` and gathers lights with `illuminance`. Each
// ray has an RtslState of its own on the stack. Only the fields that can be read are written:
// clearing all of it would take longer than many shaders do.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/engines/Background.h"
#include "runtime/device/engines/BeginRay.h"
#include "runtime/device/engines/CameraCone.h"
#include "runtime/device/engines/Emitters.h"
#include "runtime/device/engines/KnownLights.h"
#include "runtime/device/engines/ShadowRay.h"
#include "runtime/device/ray/Abi.h"
#include "runtime/device/ray/Color.h"
#include "runtime/device/ray/Divisor.h"
#include "runtime/device/ray/Events.h"
#include "runtime/device/ray/Sampler.h"
#include "runtime/device/ray/Spawn.h"
#include "runtime/device/ray/Vector.h"
#include "runtime/device/traverse/Surface.h"

namespace rtsl::device {

/// What a ray met, and the object whose method computes the color.
struct Arrival {
  enum Kind : uint32_t { Nothing, Surface, Background } kind; // Nothing: SampleColor is already set
  RtslRef object;
};

/// The background.
inline Arrival arriveAtBackground(RtslState &state) {
  clearForBackground(state);
  if (rtsl_needs(state.launch) & RTSL_NEEDS_EMITTERS)
    state.PDF = backgroundDensity(state);
  return {Arrival::Background, state.launch->background};
}

/// Describes the result of traversing state's ray.
inline Arrival arriveAt(RtslState &state, uint32_t found) {
  const RtslLaunch &launch = *state.launch;
  if (found == RTSL_HIT) {
    describeHit(state);
    describeEmitter(state);
    return {Arrival::Surface, instanceAt(launch, state.instance).material};
  }
  if (found == RTSL_MISS) {
    if (launch.background)
      return arriveAtBackground(state);
    copyColor(state.SampleColor, launch.backgroundColor, rtsl_color_components(&launch));
  }
  if (found == RTSL_BAD_RAY)
    raise(state, RTSL_EXCEPTION_BAD_RAY);
  return {Arrival::Nothing, 0};
}

/// Traverses state's ray and describes the result.
inline Arrival arrive(RtslState &state) {
  return arriveAt(state, traverseWithDefaults(state, 0));
}

/// Follows state's ray and writes the color that arrives to SampleColor.
inline void follow(RtslState &state) {
  Arrival arrival = arrive(state);
  if (arrival.kind == Arrival::Surface)
    rtsl_rt_Material_shade(&state, arrival.object);
  else if (arrival.kind == Arrival::Background)
    rtsl_rt_Miss_miss(&state, arrival.object);
}

/// Counts a ray that a shader sends. False if it is deeper than the launch allows: it is not
/// traced.
inline bool maySpawn(RtslState &parent, uint32_t *dimension) {
  *dimension = parent.dimension++; // even if nothing is traced, so that depth does not affect
                                   // later random numbers
  bool isShallow = parent.Depth < int32_t(parent.launch->maxDepth); // `generate` is at -1
  if (!isShallow) {
    raise(parent, RTSL_EXCEPTION_STACK_OVERFLOW);
    if (RtslStatus *status = parent.launch->status)
      if (!wantsLights(parent))
        countUp(&status->raysTooDeep);
  }
  return isShallow && !isAbandoned(parent);
}

/// Initialises `child` as a ray that `parent` sends, except for the ray itself.
inline void descend(RtslState &child, const RtslState &parent, uint32_t dimension) {
  inherit(child, parent);
  child.Depth = parent.Depth + 1;
  setChildKey(child, parent, dimension);
  child.dimension = 0;
}

/// Makes `child` the ray that `parent` sends. They may be the same.
inline void spawn(RtslState &child, const RtslState &parent, uint32_t dimension, Vec3 origin,
                  Vec3 direction) {
  beginChild(child, parent, [&](const RtslState &from) {
    descend(child, from, dimension);
    child.rayType = 0;
    setRay(child, origin, direction, startOf(from, origin, direction), infinity,
           passedDistance(from, origin, direction));
  });
}

/// `trace(origin, direction)`. A ray deeper than the launch allows has color 0.
inline void trace(RtslState &parent, Vec3 origin, Vec3 direction, float *color) {
  uint32_t components = rtsl_color_components(parent.launch);
  uint32_t dimension;
  if (!maySpawn(parent, &dimension)) {
    setColor(color, components, 0);
    return;
  }
  RtslState state;
  spawn(state, parent, dimension, origin, direction);
  follow(state);
  copyColor(color, state.SampleColor, components);
}

/// isInCone for vectors whose squares would leave the range of a float. A direction that no ray can
/// have is in every cone, so that the shadow ray raises the exception.
__attribute__((cold)) inline bool isInConeOfExtremes(Vec3 direction, Vec3 axis, float cosAngle) {
  if (!isFinite(direction) || largest(direction) == 0)
    return true;
  return dot(normalized(direction), normalized(axis)) >= cosAngle;
}

/// Is the angle between two vectors of any length at most the one with the given cosine? Compares
/// squares, without a square root.
inline bool isInCone(Vec3 direction, Vec3 axis, float cosAngle) {
  float squares = dot(direction, direction) * dot(axis, axis);
  if (!(squares > 0x1p-60f && squares < 0x1p60f))
    return isInConeOfExtremes(direction, axis, cosAngle);
  float cosine = dot(direction, axis); // times both lengths
  float bound = cosAngle * cosAngle * squares;
  return cosAngle >= 0 ? cosine >= 0 && cosine * cosine >= bound
                       : cosine >= 0 || cosine * cosine <= bound;
}

/// One light of `illuminance (P [, N, angle])`, or `illuminate(index, P [, shadows])`. Returns
/// whether light arrives.
inline bool illuminate(RtslState &state, uint32_t index, Vec3 point, Vec3 axis, float cosAngle) {
  const RtslLaunch &launch = *state.launch;
  if (index >= launch.lightCount) // an index that a shader has chosen
    return false;
  uint32_t components = rtsl_color_components(&launch);
  setVector(state.LightDirection, 0, 0, 0);
  state.LightDistance = infinity;
  setColor(state.LightColor, components, 0);
  // The light's method reads the given point as HitPoint, which is restored afterwards.
  Vec3 hitPoint = load(state.HitPoint);
  store(state.HitPoint, point);
  rtsl_rt_Light_illumination(&state, launch.lights[index]);
  store(state.HitPoint, hitPoint);

  ++state.dimension; // one draw for the shadow ray, traced or not
  if (isBlack(state.LightColor, components) || !(state.LightDistance > 0))
    return false;
  Vec3 direction = load(state.LightDirection);
  if (cosAngle > -1.0f && !isInCone(direction, axis, cosAngle))
    return false;
  return cosAngle == RTSL_NO_SHADOWS || isLit(state, point);
}

/// The start of a sample of a pixel; rows count on from slice to slice. Row 0 is the top of the
/// image, where ScreenCoord.y is near 1.
inline void placeSample(RtslState &state, const RtslLaunch &launch, uint32_t x, uint32_t y,
                        uint32_t index, RtslEvents &events) {
  beginState(state, &launch);
  startEvents(state, events, x, y, index);
  const SampleNumbers numbers = beginRandomNumbers(state, x, y, index, launch.seed);
  state.Depth = 0;
  uint32_t needs = rtsl_needs(&launch);
  const uint32_t slice = quotient(y, launch.byHeight);
  const uint32_t row = y - slice * launch.height;
  if (needs & RTSL_NEEDS_LAUNCH) {
    state.LaunchIndex[0] = x;
    state.LaunchIndex[1] = row;
    state.LaunchIndex[2] = slice;
    state.LaunchSize[0] = launch.width;
    state.LaunchSize[1] = launch.height;
    state.LaunchSize[2] = launch.slices;
  }

  state.ScreenCoord[0] =
      quotient(float(x) + numbers.pixel[0], float(launch.width), launch.inverseWidth);
  state.ScreenCoord[1] =
      1.0f - quotient(float(row) + numbers.pixel[1], float(launch.height), launch.inverseHeight);
  if (needs & RTSL_NEEDS_LENS) {
    state.LensCoord[0] = numbers.lens[0];
    state.LensCoord[1] = numbers.lens[1];
  }
  if (needs & RTSL_NEEDS_TIME)
    state.TimeSeed = numbers.timeSeed;
  state.Time =
      needs & RTSL_HAS_SHUTTER
          ? fused(numbers.shutter, launch.shutterClose - launch.shutterOpen, launch.shutterOpen)
          : 0;
  state.rayType = 0;
  state.rayMask = 0xffffffffu;
  state.rayRoot = 0;
}

/// Calls the camera for the state's ScreenCoord.
inline void callCamera(RtslState &state, const RtslLaunch &launch) {
  state.du = state.dv = 0;
  setVector(state.RayOrigin, 0, 0, 0); // defaults if the camera does not write them
  setVector(state.RayDirection, 0, 0, 0);
  state.Epsilon = 0; // its ray sees everything in front of the origin
  state.HitDistance = infinity;
  rtsl_rt_Camera_generateRay(&state, launch.camera);
}

/// Writes the camera's ray to the state of a sample that begins. False if the camera sends none:
/// its direction is zero.
inline bool aimCamera(RtslState &state, const RtslLaunch &launch) {
  const uint32_t dimension = state.dimension;
  callCamera(state, launch);
  if (rtsl_needs(&launch) & RTSL_NEEDS_FOOTPRINT)
    describeCameraCone(state, launch, dimension, [&](RtslState &ray) { callCamera(ray, launch); });
  return !isZero(load(state.RayDirection));
}

/// Makes `state` the camera ray of one sample of one pixel. False if there is none: the sample is
/// black.
inline bool startSample(RtslState &state, const RtslLaunch &launch, uint32_t x, uint32_t y,
                        uint32_t index, RtslEvents &events) {
  placeSample(state, launch, x, y, index, events);
  if (!aimCamera(state, launch)) {
    setColor(state.SampleColor, rtsl_color_components(&launch), 0);
    return false;
  }
  setRay(state, load(state.RayOrigin), load(state.RayDirection), {0, 0, RTSL_NO_HIT, 0}, infinity);
  return true;
}

/// One sample of one pixel: the color that arrives along its ray.
inline void sample(const RtslLaunch &launch, uint32_t x, uint32_t y, uint32_t index, float *color) {
  RtslState state;
  RtslEvents events;
  if (startSample(state, launch, x, y, index, events))
    follow(state);
  endEvents(state);
  copyColor(color, state.SampleColor, rtsl_color_components(&launch));
}

} // namespace rtsl::device
