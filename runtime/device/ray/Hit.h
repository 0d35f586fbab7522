//===- Hit.h - which of two hits wins -------------------------------------===//
//
// The result must not depend on the order in which a traversal finds hits. So the nearest hit wins,
// and of two at the same distance the one with the lower (instance, primitive); and `intersect` of
// a primitive runs as if the primitive were alone: HitDistance is the end of the ray, or the
// primitive's own hit, and the nearest hit of all is stored separately.
//
// A traversal skips boxes that begin beyond the nearest hit. By rounding, or by a mistake of its
// author, a primitive may report a hit that is outside of its box. Such a hit is compared as if it
// were where the ray enters or leaves the box: then it wins or loses in every traversal.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/ray/Abi.h"
#include "runtime/device/ray/Box.h"

namespace rtsl::device {

inline const RtslInstance &instanceAt(const RtslLaunch &launch, uint32_t number) {
  return rtsl_instances(&launch)[number];
}

/// Does a hit beat the one so far?
inline bool wins(const RtslState &state, float t, uint32_t instance, uint32_t primitive) {
  if (t < state.nearest)
    return true;
  return t == state.nearest && state.instance != RTSL_NO_HIT &&
         (instance < state.instance || (instance == state.instance && primitive < state.primitive));
}

/// To be called when the state has another hit: RtslState::vertices of that.
inline void keepVertices([[maybe_unused]] RtslState &state,
                         [[maybe_unused]] const float *vertices) {
#ifndef __NVPTX__
  state.vertices = vertices;
#endif
}

/// `t` is the distance of the hit, `compared` the distance for `wins`.
inline void commit(RtslState &state, float t, float compared, uint32_t instance,
                   uint32_t primitive) {
  state.foundDistance = t;
  state.nearest = compared;
  state.instance = instance;
  state.primitive = primitive;
  keepVertices(state, nullptr);
}

/// `hit(t)`: is it the nearest hit of the primitive that is being tested?
inline bool reportHit(RtslState &state, float t) {
  if (!(t > state.Epsilon && t < state.HitDistance))
    return false;
  state.HitDistance = t;
  float compared = t < state.candidateNear  ? state.candidateNear
                   : t > state.candidateFar ? state.candidateFar
                                            : t;
  if (wins(state, compared, state.candidateInstance, state.candidatePrimitive))
    commit(state, t, compared, state.candidateInstance, state.candidatePrimitive);
  return true;
}

/// Does the ray leave the candidate? Other primitives of the same object are other surfaces. False
/// where it does not matter.
inline bool leavesCandidate(const RtslState &state) {
  return (rtsl_needs(state.launch) & RTSL_NEEDS_HIT_ERRORS) != 0 &&
         state.candidateInstance == state.leaves &&
         (!hasCounts(*state.launch) || state.candidatePrimitive == state.leavesPrimitive);
}

/// For a ray towards a point at distance 1, such as one towards a light: a hit before this distance
/// hides the point.
constexpr float hiddenBefore = 1 - 0x1p-10f;

/// How rtsl_traverse searches for such a ray, beside RTSL_FIRST_HIT and the others: for the nearest
/// hit, or any one that hides the point.
constexpr uint32_t towardsPoint = 8;
static_assert(!(towardsPoint & (RTSL_FIRST_HIT | RTSL_INVOKE_ANY_HIT | RTSL_IN_ORDER)));

/// Is the point hidden? By `nearest`, which only decreases during a search, so that the answer does
/// not depend on the order of hits.
inline bool isPointHidden(const RtslState &state) {
  return state.nearest <= hiddenBefore;
}

/// Does a search end, now that a hit was committed?
inline bool endsWithHit(const RtslState &state, uint32_t how) {
  return how & RTSL_FIRST_HIT || (how & towardsPoint && isPointHidden(state));
}

/// To be called before a traversal: nothing is hit yet up to HitDistance, the ray's end.
inline void beginSearch(RtslState &state) {
  state.nearest = state.HitDistance;
  state.areAttributesLost = 0;
#ifdef RTSL_IN_PROGRAM
  if (rtsl_tests_all_listed())
    state.isInOrder = 0;
#endif
}

/// To be called after it: HitDistance becomes that of the hit, if there is one. Returns RTSL_HIT or
/// RTSL_MISS.
inline uint32_t endSearch(RtslState &state) {
  if (state.instance == RTSL_NO_HIT)
    return RTSL_MISS;
  state.HitDistance = state.foundDistance;
  return RTSL_HIT;
}

} // namespace rtsl::device
