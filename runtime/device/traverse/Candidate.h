//===- Candidate.h - state of a primitive before it is hit ----------------===//
#pragma once

#include "runtime/device/ray/Abi.h"
#include "runtime/device/ray/Vector.h"

namespace rtsl::device {

inline void setIdentity(float m[16]) {
  for (int i = 0; i < 16; ++i)
    m[i] = i % 5 == 0 ? 1.0f : 0.0f;
}

/// The bounds of an RTSL primitive's instance, from `computeBounds`.
inline void describeBounds(RtslState &state, const RtslInstance &instance) {
  store(state.BoundMin, load(instance.boundMin));
  store(state.BoundMax, load(instance.boundMax));
}

/// State of the tested primitive and its transforms that `intersect` may read.
inline void describeCandidate(RtslState &state) {
  describeBounds(state, state.launch->instances[state.candidateInstance]);
  state.PrimitiveIndex = int32_t(state.candidatePrimitive);
  state.InstanceIndex = int32_t(state.candidateInstance);
  setIdentity(state.ObjectToWorld); // geometry is in world space so far
  setIdentity(state.WorldToObject);
}

/// Sets the primitive whose `intersect` is to run.
inline void beginCandidate(RtslState &state, uint32_t instance, uint32_t primitive) {
  state.candidateInstance = instance;
  state.candidatePrimitive = primitive;
  if (rtsl_needs(state.launch) & RTSL_NEEDS_CANDIDATE)
    describeCandidate(state);
}

} // namespace rtsl::device
