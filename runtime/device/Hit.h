//===- Hit.h - which of two hits wins -------------------------------------===//
#pragma once

#include "runtime/device/Abi.h"

namespace rtsl::device {

/// The rule of `hit(t)`: a candidate wins iff Epsilon < t < HitDistance, or t == HitDistance and
/// (instance, primitive) is lower than that of the hit so far, so that the order of traversal
/// cannot show.
inline bool wins(const RtslState &state, float t, uint32_t instance, uint32_t primitive) {
  if (!(t > state.Epsilon))
    return false;
  if (t < state.HitDistance)
    return true;
  return t == state.HitDistance && state.instance != RTSL_NO_HIT &&
         (instance < state.instance || (instance == state.instance && primitive < state.primitive));
}

/// Applies the rule to the candidate that state names.
inline bool commitCandidate(RtslState &state, float t) {
  if (!wins(state, t, state.candidateInstance, state.candidatePrimitive))
    return false;
  state.HitDistance = t;
  state.instance = state.candidateInstance;
  state.primitive = state.candidatePrimitive;
  return true;
}

} // namespace rtsl::device
