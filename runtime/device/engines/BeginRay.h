//===- BeginRay.h - the state of a ray that begins ------------------------===//
#pragma once

#include "runtime/device/ray/Abi.h"
#include "runtime/device/ray/Box.h"
#include "runtime/device/ray/Color.h"
#include "runtime/device/ray/Spawn.h"
#include "runtime/device/ray/Vector.h"
#include "runtime/device/traverse/Surface.h"

namespace rtsl::device {

/// Initialises state's ray: nothing hit yet, visible up to `distance` in units of the direction.
inline void setRay(RtslState &state, Vec3 origin, Vec3 direction, const RayStart &start,
                   float distance) {
  store(state.RayOrigin, origin);
  store(state.RayDirection, direction);
  if (rtsl_needs(state.launch) & RTSL_NEEDS_INVERSE_DIRECTION)
    setVector(state.InverseRayDirection, 1.0f / direction.x, 1.0f / direction.y,
              1.0f / direction.z);
  state.Epsilon = start.epsilon;
  state.HitDistance = distance;
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

} // namespace rtsl::device
