//===- StepCounts.h - counts the steps of warps ---------------------------===//
//
// How often warps take each step, and how many of their lanes take part: what a schedule can be
// judged by. Programs that do not count have no code for it.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/organisations/Job.h"
#include "runtime/device/organisations/JobLaunch.h"
#include "runtime/device/organisations/Schedule.h"
#include "runtime/device/ray/Abi.h"
#include "runtime/device/ray/Warp.h"

namespace rtsl::device {

/// The place of a step in RtslJob::stepCounts: traversal, the beginning of samples, and the states
/// from number 1 on.
inline uint32_t placeOfStep(int32_t step) {
  return uint32_t(step - Step::trace);
}

/// Counts a step. All lanes of the warp call together.
inline void countStep(const RtslJob &job, int32_t step, bool takesPart) {
  if (!rtsl_counts_steps(launchOf(job)))
    return;
  RtslStepCount &count = job.stepCounts[placeOfStep(step)];
#ifdef __NVPTX__
  const auto lanes = uint64_t(__builtin_popcount(warp::lanesWhere(takesPart)));
  if (__nvvm_read_ptx_sreg_laneid() != 0)
    return;
#else
  const uint64_t lanes = takesPart;
#endif
  __atomic_fetch_add(&count.steps, uint64_t(1), __ATOMIC_RELAXED);
  __atomic_fetch_add(&count.lanes, lanes, __ATOMIC_RELAXED);
}

inline void countState(const RtslJob &job, int32_t state) {
  if (!rtsl_counts_steps(launchOf(job)))
    return;
#ifdef __NVPTX__
  const uint32_t lanes = __nvvm_match_any_sync_i32(__nvvm_activemask(), uint32_t(state));
  if (lanes & __nvvm_read_ptx_sreg_lanemask_lt())
    return;
  const auto count = uint64_t(__builtin_popcount(lanes));
#else
  const uint64_t count = 1;
#endif
  RtslStepCount &sum = job.stepCounts[placeOfStep(state)];
  __atomic_fetch_add(&sum.steps, uint64_t(1), __ATOMIC_RELAXED);
  __atomic_fetch_add(&sum.lanes, count, __ATOMIC_RELAXED);
}

} // namespace rtsl::device
