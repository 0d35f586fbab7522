//===- Candidate.h - state of a primitive before it is hit ----------------===//
#pragma once

#include "runtime/device/ray/Abi.h"
#include "runtime/device/ray/Box.h"
#include "runtime/device/ray/Vector.h"
#include "runtime/device/traverse/Instance.h"

namespace rtsl::device {

/// Methods of a primitive that run, or not, by what others have hit or what materials read.
enum class PrimitiveMethod : uint32_t {
  Intersect,
  ComputeNormal,
  ComputeTextureCoordinates,
  ComputeDerivatives
};

/// The first dimension of the random numbers in such a method. Beyond those of any method that runs
/// once per ray, and different for each primitive: whether the method runs must not show in other
/// numbers.
inline uint32_t dimensionOf(PrimitiveMethod method, uint32_t instance, uint32_t primitive) {
  uint32_t mixed = (instance + 1) * 0x9e3779b9u ^ (primitive + 1) * 0x85ebca6bu;
  return 0x80000000u | uint32_t(method) << 28 | mixed >> 4;
}

/// The bounds of an RTSL primitive, from `computeBounds`.
inline void describeBounds(RtslState &state, const RtslInstance &instance, uint32_t primitive) {
  const RtslBox bounds = boundsOf(*state.launch, instance, primitive);
  store(state.BoundMin, load(bounds.lower));
  store(state.BoundMax, load(bounds.upper));
}

/// State of the tested primitive and its transforms that `intersect` may read.
inline void describeCandidate(RtslState &state) {
  const RtslInstance &instance = instanceAt(*state.launch, state.candidateInstance);
  describeBounds(state, instance, state.candidatePrimitive);
  state.PrimitiveIndex = int32_t(state.candidatePrimitive);
  state.InstanceIndex = int32_t(state.candidateInstance);
  if (rtsl_needs(state.launch) & RTSL_NEEDS_INSTANCE_ID)
    state.InstanceId = instance.id;
  describeTransforms(state, instance);
}

/// Sets the primitive whose `intersect` is to run.
inline void beginCandidate(RtslState &state, uint32_t instance, uint32_t primitive) {
  state.candidateInstance = instance;
  state.candidatePrimitive = primitive;
  if (rtsl_needs(state.launch) & RTSL_NEEDS_CANDIDATE)
    describeCandidate(state);
}

} // namespace rtsl::device
