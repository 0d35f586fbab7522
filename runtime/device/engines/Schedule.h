//===- Schedule.h - which step a warp takes next --------------------------===//
//
// The lanes of a warp want different steps, and the warp takes one of them; lanes that want another
// one wait. The choice affects only the time. docs/gpu.md compares the schedules.
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

/// The step that most of these lanes want; the first such one on a tie.
inline int32_t mostWanted(int32_t wish, uint32_t lanes) {
  int32_t winner = Step::nothing;
  int votes = 0;
  while (lanes) {
    const int32_t candidate = warp::valueOf(wish, __builtin_ctz(lanes));
    const uint32_t supporters = warp::lanesWhere(wish == candidate);
    const int count = __builtin_popcount(supporters);
    if (count > votes) {
      winner = candidate;
      votes = count;
    }
    lanes &= ~supporters;
  }
  return winner;
}

/// Most votes; but samples begin when half of the lanes wait for one.
inline int32_t chooseByMajority(int32_t wish) {
  const uint32_t active = warp::lanesWhere(wish != Step::nothing);
  const uint32_t waiting = warp::lanesWhere(wish == Step::sample);
  const uint32_t others = active & ~waiting;
  if (waiting && 2 * __builtin_popcount(waiting) >= __builtin_popcount(active))
    return Step::sample;
  return mostWanted(wish, others);
}

/// States before traversal, so that all lanes traverse together; and samples when all lanes wait
/// for one, so that their rays stay similar.
inline int32_t chooseByPriority(int32_t wish) {
  if (const uint32_t states = warp::lanesWhere(wish > 0))
    return mostWanted(wish, states);
  if (warp::lanesWhere(wish == Step::trace))
    return Step::trace;
  return warp::lanesWhere(wish == Step::sample) ? Step::sample : Step::nothing;
}

/// Each step in its turn.
inline int32_t chooseInTurn(int32_t wish, int32_t &last) {
  for (int round = 0; round < 2; ++round) {
    const uint32_t later = warp::lanesWhere(wish > last);
    if (later)
      return last = warp::smallest(later, wish);
    last = Step::nothing;
  }
  return Step::nothing;
}

/// What the first lane wants.
inline int32_t chooseNaively(int32_t wish) {
  const uint32_t active = warp::lanesWhere(wish != Step::nothing);
  return active ? warp::valueOf(wish, __builtin_ctz(active)) : Step::nothing;
}

/// The next step of the warp; Step::nothing if no lane wants any other. All lanes call together.
/// `last` is the last choice.
inline int32_t chooseStep(uint32_t schedule, int32_t wish, int32_t last) {
  switch (schedule) {
  case RTSL_SCHEDULE_PRIORITIZED:
    return chooseByPriority(wish);
  case RTSL_SCHEDULE_ROUND_ROBIN:
    return chooseInTurn(wish, last);
  case RTSL_SCHEDULE_NAIVE:
    return chooseNaively(wish);
  default:
    return chooseByMajority(wish);
  }
}

#else

inline int32_t chooseStep(uint32_t, int32_t wish, int32_t) {
  return wish;
}

#endif

} // namespace rtsl::device
