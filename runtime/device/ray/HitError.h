//===- HitError.h - errors of hits, and rays that leave a primitive -------===//
//
// A ray that starts on a user primitive must not hit the surface there again. The t that an
// `intersect` computes has two rounding errors: when the surface was hit, which moved the new ray's
// origin off it (Spawn.h), and when the new ray is tested against the same primitive. The author
// states a bound of the error with `hit(t, error)`, or the compiler derives one from the arithmetic
// of `intersect` (codegen/passes/errors/BoundHitError.h). The second error is handled here.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/ray/Box.h"
#include "runtime/device/ray/Hit.h"
#include "runtime/device/ray/InOrder.h"
#include "runtime/device/ray/Vector.h"

namespace rtsl::device {

/// RtslState::hitError where the author states none.
constexpr float errorNotStated = -1;

/// The same if the derived function finds no hit at that distance. With non-strict arithmetic it
/// may round differently from `intersect`, which decides whether a grazing ray has a hit at all.
constexpr float hitNotFound = -2;

/// Is it a valid bound?
inline bool isBound(float error) {
  return isFiniteFromZero(error);
}

/// The error of t at a hit of `primitive`, computed by its derived function `derive`; below 0: not
/// known.
template <typename Derive>
float derivedHitError(RtslState &state, RtslRef primitive, float t, Derive derive) {
  const float distance = state.HitDistance, error = state.hitError;
  state.HitDistance = t;
  state.hitError = errorNotStated;
  derive(&state, primitive);
  const float bound = state.hitError;
  state.HitDistance = distance;
  state.hitError = error;
  return bound;
}

/// The same for the candidate.
__attribute__((cold, noinline)) inline float derivedErrorOfCandidate(RtslState &state, float t) {
  const RtslRef primitive = instanceAt(*state.launch, state.candidateInstance).primitive;
  return derivedHitError(state, primitive, t, rtsl_rt_Primitive_rt_boundHitError);
}

/// Does the ray leave the candidate, and is t so small that the hit may be its own start? Then it
/// is not certain that the hit is ahead (Pharr, Jakob and Humphreys, "Physically Based Rendering",
/// 3rd edition, 2016, 3.9.6).
inline bool mayBeWhereItStarts(RtslState &state, float t, float error) {
  if (!leavesCandidate(state))
    return false;
  if (error == errorNotStated)
    error = derivedErrorOfCandidate(state, t);
  return error == hitNotFound || (isBound(error) && t - error <= state.Epsilon);
}

/// `hit(t, error)`: the rule of Hit.h, except for hits that may be the start of the ray. `error`
/// may be errorNotStated.
inline bool reportHitWithin(RtslState &state, float t, float error) {
  if (InOrder::isOn(state))
    return InOrder::reportHit(state, t, error);
  if (t > state.Epsilon && t < state.HitDistance && mayBeWhereItStarts(state, t, error))
    return false;
  if (!reportHit(state, t))
    return false;
  const bool hasWon = state.instance == state.candidateInstance && state.foundDistance == t &&
                      (!hasCounts(*state.launch) || state.primitive == state.candidatePrimitive);
  if (hasWon)
    state.hitError = error;
  return true;
}

} // namespace rtsl::device
