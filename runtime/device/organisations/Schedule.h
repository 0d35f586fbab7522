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

constexpr uint32_t noLane = 0xffffffffu; // a key that is never the least, if there is another one

/// The step of the lane whose key is the least; the last five bits of keys are numbers of lanes.
inline int32_t stepOfLeast(int32_t next, uint32_t key) {
  return warp::valueOf(next, int32_t(warp::least(key) & 31));
}

/// The most frequent step of the lanes that take part; on a tie that of the first lane.
inline int32_t mostFrequent(int32_t next, bool takesPart) {
  const uint32_t lanes = warp::lanesWith(next);
  const auto others = uint32_t(32 - __builtin_popcount(lanes));
  return stepOfLeast(next, takesPart ? others << 5 | uint32_t(__builtin_ctz(lanes)) : noLane);
}

/// The most frequent step; but samples begin when half of the lanes wait for one.
inline int32_t chooseByMajority(int32_t next) {
  const uint32_t active = warp::lanesWhere(next != Step::nothing);
  const uint32_t waiting = warp::lanesWhere(next == Step::sample);
  if (!active)
    return Step::nothing;
  if (waiting && 2 * __builtin_popcount(waiting) >= __builtin_popcount(active))
    return Step::sample;
  return mostFrequent(next, next != Step::nothing && next != Step::sample);
}

/// States before traversal, so that all lanes traverse together; and samples when all lanes wait
/// for one, so that their rays stay similar. Of the states the one with the least number, which is
/// nearest to the beginning of its method: its lanes may join those that wait for a later one.
inline int32_t chooseByPriority(int32_t next) {
  const uint32_t state = warp::least(next > 0 ? uint32_t(next) : noLane);
  if (state != noLane)
    return int32_t(state);
  if (warp::lanesWhere(next == Step::trace))
    return Step::trace;
  return warp::lanesWhere(next == Step::sample) ? Step::sample : Step::nothing;
}

/// 0 to 15: the logarithm of the cost of the step.
inline uint32_t costOf(const RtslLaunch *launch, int32_t step) {
  const uint64_t costs = uint64_t(rtsl_step_costs_high(launch)) << 32 | rtsl_step_costs_low(launch);
  const auto place = uint32_t(step - Step::trace);
  return uint32_t(costs >> 4 * (place < 15 ? place : 15)) & 15;
}

/// The step that wastes the least: its cost, for each lane that waits meanwhile. So lanes gather
/// before expensive steps.
inline int32_t chooseLeastWaste(const RtslLaunch *launch, int32_t next) {
  const uint32_t active = warp::lanesWhere(next != Step::nothing);
  const uint32_t lanes = warp::lanesWith(next);
  if (!active)
    return Step::nothing;
  const auto idle = uint32_t(__builtin_popcount(active) - __builtin_popcount(lanes));
  const uint32_t key = idle << costOf(launch, next) << 5 | uint32_t(__builtin_ctz(lanes));
  return stepOfLeast(next, next == Step::nothing ? noLane : key);
}

/// The step that wastes the least, of traversal and new samples.
inline int32_t chooseOfTwo(const RtslLaunch *launch, int32_t next) {
  const uint32_t rays = warp::lanesWhere(next == Step::trace);
  const uint32_t samples = warp::lanesWhere(next == Step::sample);
  if (!rays)
    return samples ? Step::sample : Step::nothing;
  if (!samples)
    return Step::trace;
  if (rtsl_schedule(launch) != RTSL_SCHEDULE_LEAST_WASTE)
    return Step::trace;
  const auto wasteOf = [&](int32_t step, uint32_t idle) {
    return uint32_t(__builtin_popcount(idle)) << costOf(launch, step);
  };
  return wasteOf(Step::trace, samples) <= wasteOf(Step::sample, rays) ? Step::trace : Step::sample;
}

/// Each step in its turn.
inline int32_t chooseInTurn(int32_t next, int32_t &last) {
  for (int round = 0; round < 2; ++round) {
    const uint32_t later = warp::least(next > last ? uint32_t(next - Step::nothing) : noLane);
    if (later != noLane)
      return last = int32_t(later) + Step::nothing;
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
inline int32_t chooseStep(const RtslLaunch *launch, int32_t next, int32_t last) {
  if (rtsl_states_run_on(launch))
    return chooseOfTwo(launch, next);
  switch (rtsl_schedule(launch)) {
  case RTSL_SCHEDULE_PRIORITIZED:
    return chooseByPriority(next);
  case RTSL_SCHEDULE_LEAST_WASTE:
    return chooseLeastWaste(launch, next);
  case RTSL_SCHEDULE_ROUND_ROBIN:
    return chooseInTurn(next, last);
  case RTSL_SCHEDULE_NAIVE:
    return chooseNaively(next);
  default:
    return chooseByMajority(next);
  }
}

#else

inline int32_t chooseStep(const RtslLaunch *, int32_t next, int32_t) {
  return next;
}

#endif

} // namespace rtsl::device
