//===- Schedule.h - which step a warp takes next --------------------------===//
//
// The lanes of a warp need different steps, and the warp takes one of them; lanes that need another
// one wait. The choice affects only the time. docs/gpu.md compares the schedules. In all functions
// `next` is the next step of the lane that calls.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/ray/Abi.h"
#include "runtime/device/ray/Warp.h"

namespace rtsl::device {

/// The steps that are not states, whose numbers are above 0.
struct Step {
  static constexpr int32_t sample = 0; // end the sample, and begin another one
  static constexpr int32_t trace = -1;
  static constexpr int32_t nothing = -2; // no sample is left
};

#ifdef __NVPTX__

/// The step that most of these lanes need; on a tie that of the first lane.
inline int32_t mostFrequent(int32_t next, uint32_t lanes) {
  int32_t found = Step::nothing;
  int most = 0;
  while (lanes) {
    const int32_t step = warp::valueOf(next, __builtin_ctz(lanes));
    const uint32_t lanesOfStep = warp::lanesWhere(next == step);
    const int count = __builtin_popcount(lanesOfStep);
    if (count > most) {
      found = step;
      most = count;
    }
    lanes &= ~lanesOfStep;
  }
  return found;
}

/// The most frequent step; but samples begin when half of the lanes wait for one.
inline int32_t chooseByMajority(int32_t next) {
  const uint32_t active = warp::lanesWhere(next != Step::nothing);
  const uint32_t waiting = warp::lanesWhere(next == Step::sample);
  const uint32_t others = active & ~waiting;
  if (waiting && 2 * __builtin_popcount(waiting) >= __builtin_popcount(active))
    return Step::sample;
  return mostFrequent(next, others);
}

/// States before traversal, so that all lanes traverse together; and samples when all lanes wait
/// for one, so that their rays stay similar.
inline int32_t chooseByPriority(int32_t next) {
  if (const uint32_t states = warp::lanesWhere(next > 0))
    return mostFrequent(next, states);
  if (warp::lanesWhere(next == Step::trace))
    return Step::trace;
  return warp::lanesWhere(next == Step::sample) ? Step::sample : Step::nothing;
}

/// Each step in its turn.
inline int32_t chooseInTurn(int32_t next, int32_t &last) {
  for (int round = 0; round < 2; ++round) {
    const uint32_t later = warp::lanesWhere(next > last);
    if (later)
      return last = warp::smallest(later, next);
    last = Step::nothing;
  }
  return Step::nothing;
}

/// The step of the first lane.
inline int32_t chooseNaively(int32_t next) {
  const uint32_t active = warp::lanesWhere(next != Step::nothing);
  return active ? warp::valueOf(next, __builtin_ctz(active)) : Step::nothing;
}

/// The next step of the warp; Step::nothing if no lane needs any other. All lanes call together.
/// `last` is the last choice.
inline int32_t chooseStep(uint32_t schedule, int32_t next, int32_t last) {
  switch (schedule) {
  case RTSL_SCHEDULE_PRIORITIZED:
    return chooseByPriority(next);
  case RTSL_SCHEDULE_ROUND_ROBIN:
    return chooseInTurn(next, last);
  case RTSL_SCHEDULE_NAIVE:
    return chooseNaively(next);
  default:
    return chooseByMajority(next);
  }
}

#else

inline int32_t chooseStep(uint32_t, int32_t next, int32_t) {
  return next;
}

#endif

} // namespace rtsl::device
