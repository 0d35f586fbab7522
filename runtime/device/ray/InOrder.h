//===- InOrder.h - hits where all primitives of a list are tested ---------===//
#pragma once

#include "runtime/device/ray/Hit.h"

namespace rtsl::device {

/// While it exists, all primitives of a list are tested in the order of their instances, and hits
/// are compared at their own distances: with --fp=fast, where boxes do not decide which hits count.
/// Then a hit wins if it is nearer than the one so far, and a program that does not ask for the
/// result of `hit` makes no other comparison. Hits on the primitive that the ray leaves do not
/// count yet: whether one is the ray's own start takes long to decide (HitError.h).
class InOrder {
public:
  explicit InOrder(RtslState &state) : state(state) {
    state.isInOrder = 1;
    state.isStartPutOff = 0;
    // As for any hit, so that nothing has to be selected.
    state.foundDistance = state.nearest;
    state.primitive = 0;
  }
  InOrder(const InOrder &) = delete;
  ~InOrder() { state.isInOrder = 0; }

  /// Is there one?
  static bool isOn([[maybe_unused]] const RtslState &state) {
#ifdef RTSL_IN_PROGRAM
    return rtsl_tests_all_listed() && state.isInOrder;
#else
    return false;
#endif
  }

  /// `hit(t)` meanwhile, without jumps.
  static bool reportHit(RtslState &state, float t, float error) {
    const bool isLeft = leavesCandidate(state);
    const bool isAhead = t > state.Epsilon, isNearest = isAhead & (t < state.HitDistance);
    state.isStartPutOff |= uint32_t(isLeft & isAhead & !rtsl_rays_leave_planes());
    const bool counts = isNearest & !isLeft;
    if (!isLeft & isAhead & (t < state.nearest)) {
      commit(state, t, t, state.candidateInstance, 0);
      state.hitError = error;
    }
    state.HitDistance = counts ? t : state.HitDistance;
    return counts;
  }

private:
  RtslState &state;
};

} // namespace rtsl::device
