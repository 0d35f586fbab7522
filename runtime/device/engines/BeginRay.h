//===- BeginRay.h - the state of a ray that begins ------------------------===//
#pragma once

#include "runtime/device/engines/KnownLights.h"
#include "runtime/device/ray/Abi.h"
#include "runtime/device/ray/Box.h"
#include "runtime/device/ray/Color.h"
#include "runtime/device/ray/Events.h"
#include "runtime/device/ray/Spawn.h"
#include "runtime/device/ray/Undefined.h"
#include "runtime/device/ray/Vector.h"
#include "runtime/device/traverse/Surface.h"

namespace rtsl::device {

/// Begins a state of the launch, with all other fields undefined.
inline void beginState(RtslState &state, const RtslLaunch *launch) {
  state.launch = launch;
  makeUndefined(state, &state, &state + 1);
  state.launch = launch;
  knowNoLights(state);
}

/// Copies what is the same for all rays of a sample from one of them.
inline void takeFromSample(RtslState &state, const RtslState &other) {
  state.events = other.events;
  state.TimeSeed = other.TimeSeed;
  for (int i = 0; i < 2; ++i) {
    state.ScreenCoord[i] = other.ScreenCoord[i];
    state.LensCoord[i] = other.LensCoord[i];
  }
  for (int i = 0; i < 3; ++i) {
    state.LaunchIndex[i] = other.LaunchIndex[i];
    state.LaunchSize[i] = other.LaunchSize[i];
  }
}

/// Do methods read the launch index and size that run for rays which shaders send?
inline bool doRaysReadLaunch(const RtslLaunch &launch) {
  return rtsl_needs(&launch) & RTSL_NEEDS_LAUNCH && rtsl_rays_read_launch();
}

/// What a ray inherits from the ray that sent it.
inline void inherit(RtslState &state, const RtslState &parent) {
  state.launch = parent.launch;
  const uint32_t needs = rtsl_needs(parent.launch);
  if (needs & RTSL_NEEDS_TIME)
    state.TimeSeed = parent.TimeSeed;
  state.Time = parent.Time; // rays with a payload pass it on, whether it is read or not
  for (int i = 0; i < 3 && doRaysReadLaunch(*parent.launch); ++i) {
    state.LaunchIndex[i] = parent.LaunchIndex[i];
    state.LaunchSize[i] = parent.LaunchSize[i];
  }
  if (needs & RTSL_NEEDS_FOOTPRINT) { // as from a plane mirror
    state.coneAtOrigin = parent.ConeWidth;
    state.ConeSpread = parent.ConeSpread;
  }
  state.rayMask = parent.rayMask;
  state.rayRoot = parent.rayRoot;
  if (hasEvents(parent))
    state.events = parent.events;
}

/// Makes `child` a new state and calls make(parent), where `parent` has its old value even if the
/// two are the same.
template <typename Make>
inline void beginChild(RtslState &child, const RtslState &parent, Make make) {
  if (undefinedWord(parent) == 0) {
    make(parent);
    return;
  }
  const RtslState before = parent;
  beginState(child, before.launch);
  if (&child == &parent) // the only state of the machine, which is still read as the parent
    takeFromSample(child, before);
  make(before);
}

/// Do rays have a passedDistance? If light of emitters passes surfaces.
inline bool hasPassedDistance(const RtslLaunch &launch) {
  return rtsl_needs(&launch) & RTSL_NEEDS_EMITTERS && rtsl_light_passes(&launch) &&
         rtsl_emitter_count(&launch) != 0;
}

/// RtslState::passedDistance of a ray that a shader sends after `from` has hit a surface: straight
/// on is within 1e-5 of the old direction, which materials may compute in the surface's frame.
inline float passedDistance(const RtslState &from, Vec3 origin, Vec3 direction) {
  if (!hasPassedDistance(*from.launch) || !startsAtHit(leftHit(from), origin))
    return 0;
  const Vec3 before = load(from.RayDirection), across = cross(before, direction);
  const float squares = dot(before, before) * dot(direction, direction);
  if (!(dot(across, across) <= 1e-10f * squares && dot(before, direction) > 0))
    return 0;
  return (from.passedDistance + from.HitDistance) *
         squareRoot(dot(before, before) / dot(direction, direction));
}

/// Initialises state's ray: nothing hit yet, visible up to `distance` in units of the direction.
/// `passed`: RtslState::passedDistance.
inline void setRay(RtslState &state, Vec3 origin, Vec3 direction, const RayStart &start,
                   float distance, float passed = 0) {
  store(state.RayOrigin, origin);
  store(state.RayDirection, direction);
  if (rtsl_needs(state.launch) & RTSL_NEEDS_INVERSE_DIRECTION)
    setVector(state.InverseRayDirection, 1.0f / direction.x, 1.0f / direction.y,
              1.0f / direction.z);
  state.Epsilon = start.epsilon;
  state.HitDistance = distance;
  if (hasPassedDistance(*state.launch))
    state.passedDistance = passed;
  state.isEasy = start.isEasy;
  if (rtsl_needs(state.launch) & RTSL_NEEDS_ANY_HIT)
    state.hitAnswer = RTSL_ACCEPT;
  if (rtsl_needs(state.launch) & RTSL_NEEDS_HIT_ERRORS) {
    state.leaves = start.leaves;
    if (hasCounts(*state.launch))
      state.leavesPrimitive = start.leavesPrimitive;
  }
  state.instance = RTSL_NO_HIT;
  state.primitive = RTSL_NO_HIT;
}

/// State that a method may read although it was not written for this ray.
inline void setDefaults(RtslState &state, uint32_t components) {
  setColor(state.SampleColor, components, 0);
  setColor(state.LightColor, components, 0);
  setVector(state.LightDirection, 0, 0, 0);
  state.LightDistance = infinity;
  if (rtsl_needs(state.launch) & RTSL_NEEDS_SAMPLING) {
    setColor(state.EmissionColor, components, 0);
    setColor(state.BSDFValue, components, 0);
    state.BSDFSeed[0] = state.BSDFSeed[1] = 0;
    state.PDF = 0;
    state.du = state.dv = 0;
  }
}

/// Traverses state's ray, and sets its defaults. They are set after the search, where stores that a
/// method repeats are left out, unless `anyHit` may read them.
inline uint32_t traverseWithDefaults(RtslState &state, uint32_t how) {
  const uint32_t needs = rtsl_needs(state.launch), components = rtsl_color_components(state.launch);
  if (needs & RTSL_NEEDS_ANY_HIT)
    setDefaults(state, components);
  else if (needs & RTSL_NEEDS_SAMPLING)
    state.PDF = 0; // which `intersect` may read
  const uint32_t found = rtsl_traverse(&state, how);
  if (!(needs & RTSL_NEEDS_ANY_HIT))
    setDefaults(state, components);
  return found;
}

} // namespace rtsl::device
