//===- Megakernel.h - a whole scene as one program ------------------------===//
//
// The machine of Machine.h with its traversal, for any number of lanes. A lane renders one sample
// after another; the lanes of a warp choose the next step together: the ray's traversal, one of the
// states, or the beginning of another sample (Schedule.h). Lanes with another step wait. The choice
// affects only the time: a lane's rays are its own.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/engines/Machine.h"
#include "runtime/device/organisations/Job.h"
#include "runtime/device/organisations/JobLaunch.h"
#include "runtime/device/organisations/LanePixel.h"
#include "runtime/device/organisations/Schedule.h"
#include "runtime/device/organisations/Slice.h"
#include "runtime/device/organisations/StepCounts.h"
#include "runtime/device/ray/Abi.h"

namespace rtsl::device {

static_assert(Rays::none == Step::sample && Rays::trace == Step::trace);

/// Stacks up to this size are local variables of the lane, unless their size is fixed by the
/// program.
constexpr uint64_t localStackBytes = 2048;

/// Whether the lane's stack is a local variable. On CPUs only if the program needs just one level,
/// so that its words may stay in registers. On a GPU the words of a local variable are interleaved
/// with those of the neighbouring lanes.
inline bool hasLocalStack(const RtslLaunch *launch, uint32_t maxDepth, uint32_t referenceChain) {
#ifdef __NVPTX__
  return stackSize(launch, maxDepth, referenceChain) <= localStackBytes;
#else
  RtslState none;
  return rtsl_rays_wait_once(&none) && !rtsl_calls(&none) &&
         stackSize(launch, maxDepth, referenceChain) <= localStackBytes;
#endif
}

inline uint64_t laneBytes(uint32_t maxDepth, uint32_t referenceChain) {
  return stackSize(nullptr, maxDepth, referenceChain);
}

/// Whether the memory of a lane, or of the stack of a slot, has as many bytes as the program needs;
/// otherwise the job has a problem.
inline bool hasLaneBytes(const RtslJob &job, uint64_t needed) {
  if (needed <= job.laneBytes)
    return true;
  __atomic_store_n(&job.status->problem, RTSL_PROBLEM_STACK, __ATOMIC_RELAXED);
  return false;
}

/// Starts a sample of the slice. False if it was rendered before.
inline bool beginSample(const RtslJob &job, uint32_t sample, Rays &rays) {
  PixelSample found;
  if (!findSample(job, sample, found))
    return false;
  startRays(rays, *launchOf(job), job.left + found.pixel.x, job.top + found.pixel.y, found.number);
  return true;
}

inline void storeSample(const RtslJob &job, uint32_t sample, Rays &rays) {
  endSample(rays);
  storeColor(job, sample, rays.ray.state.SampleColor);
}

/// The step of the lanes that begin a sample: they store that before. All lanes of a warp call
/// together.
inline void stepToNextSample(const RtslJob &job, TakenSamples &taken, uint32_t &sample,
                             bool takesPart, Rays &rays) {
  const uint32_t following = takeSample(job, taken, takesPart);
  if (!takesPart)
    return;
  if (sample != TakenSamples::none)
    storeSample(job, sample, rays);
  sample = following;
  if (sample >= samplesOfSlice(job))
    rays.next = Step::nothing;
  else if (!beginSample(job, sample, rays))
    sample = TakenSamples::none;
}

/// The same if lanes take pixels.
inline void stepToNextSample(const RtslJob &job, TakenSamples &taken, LanePixel &own,
                             bool takesPart, Rays &rays) {
  if (takesPart && own.isThere())
    endSample(rays);
  goToNextSample(job, taken, own, takesPart, rays.ray.state.SampleColor);
  if (!takesPart)
    return;
  if (own.isThere())
    startRays(rays, *launchOf(job), job.left + own.pixel.x, job.top + own.pixel.y, own.sample);
  else
    rays.next = Step::nothing;
}

/// Runs states until the lane has to trace a ray, or its sample is over. The code generator
/// recognises the loop by its mark (keepStatesInLoop in codegen/emit/LlvmModule.cpp).
inline void runStates(const RtslJob &job, Rays &rays) {
#ifdef __clang__
#pragma clang loop unroll(disable) pipeline(disable)
#endif
  while (rays.next > 0) {
    countState(job, rays.next);
    runState(rays, rays.next);
  }
}

/// rtsl_run_lane.
inline void runLane(const RtslJob &job, uint32_t number) {
  if (!hasLaneBytes(job, laneBytes(launchOf(job)->maxDepth, launchOf(job)->referenceChain)))
    return;
  alignas(16) char local[localStackBytes];
  Rays rays;
  rays.bottom = hasLocalStack(launchOf(job), launchOf(job)->maxDepth, launchOf(job)->referenceChain)
                    ? local
                    : reinterpret_cast<char *>(job.lanes + number * job.laneBytes);
  TakenSamples taken;
  const bool takesPixels = lanesTakePixels(job);
  if (takesPixels)
    __atomic_store_n(&job.status->hasSums, 1, __ATOMIC_RELAXED);
  LanePixel pixel;                      // of lanes that take pixels
  uint32_t sample = TakenSamples::none; // of others
  int32_t choice = Step::nothing;
  rays.next = Step::sample;
  for (;;) {
    choice = chooseStep(launchOf(job), rays.next, choice);
    if (choice == Step::nothing)
      return;
    const bool takesPart = rays.next == choice;
    countStep(job, choice, takesPart);
    if (choice == Step::sample) {
      if (takesPixels)
        stepToNextSample(job, taken, pixel, takesPart, rays);
      else
        stepToNextSample(job, taken, sample, takesPart, rays);
    } else if (takesPart) {
      if (choice == Step::trace)
        traceRay(rays);
      else
        runState(rays, choice);
    }
    if (rtsl_states_run_on(launchOf(job)) && takesPart)
      runStates(job, rays);
  }
}

} // namespace rtsl::device
