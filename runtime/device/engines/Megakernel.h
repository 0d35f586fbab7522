//===- Megakernel.h - a whole scene as one program ------------------------===//
//
// The machine of Machine.h with its traversal, for any number of lanes. A lane renders one pixel
// after another; the lanes of a warp vote for the next step: the ray's traversal, one of the
// states, or the beginning of another sample. Lanes with another step wait. The vote affects only
// the time: a lane's rays are its own.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/engines/Machine.h"
#include "runtime/device/ray/Abi.h"
#include "runtime/device/ray/Warp.h"

namespace rtsl::device {

/// The pixel that a lane renders. A local variable of the lane, like its current ray; only the
/// stack of waiting rays is in memory.
struct Lane {
  double sum[RTSL_MAX_COLOR]; // of the pixel's samples, in their order
  uint64_t pixel;             // of the job
  uint32_t sample;            // the next one in the pixel
  uint32_t notFinite;         // samples of the pixel that were left out
};

/// The step of a lane without a pixel, in addition to the values of Rays::next.
constexpr int32_t nothingLeft = -2;

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

/// Adds a sample to the list of the first that are not finite; safe for concurrent calls: each
/// entry keeps the earlier of two samples and passes the other one on to the next entry.
inline void noteNotFinite(RtslStatus &status, uint64_t sample) {
  uint64_t rank = ~sample; // larger for earlier samples, and never 0
  for (uint64_t &place : status.firstNotFinite) {
    uint64_t held = __atomic_load_n(&place, __ATOMIC_RELAXED);
    while (held < rank && !__atomic_compare_exchange_n(&place, &held, rank, false, __ATOMIC_RELAXED,
                                                       __ATOMIC_RELAXED))
      ;
    if (held < rank)
      rank = held;
    if (rank == 0)
      return;
  }
}

inline bool hasSums(const RtslJob &job) {
  return job.sums.colors;
}

/// Adds the square of a sample's value to that of its pixel. In memory: it would take registers of
/// all renderings.
inline void addSquare(const RtslJob &job, const Lane &lane, const float *color) {
  const uint32_t components = rtsl_color_components(job.launch);
  double value = 0;
  forEachComponent(components, [&](uint32_t i) { value += double(color[i]); });
  value /= double(components);
  job.sums.squares[lane.pixel] += value * value;
}

/// Adds the color of a finished sample to its pixel. One that is not finite is left out of the
/// pixel's mean, which would not be finite either.
inline void addSample(const RtslJob &job, Lane &lane, const float *color) {
  bool isNotFinite = false;
  forEachComponent(rtsl_color_components(job.launch),
                   [&](uint32_t i) { isNotFinite |= !(absolute(color[i]) < infinity); });
  if (isNotFinite) {
    ++lane.notFinite;
    countUp(&job.status->samplesNotFinite);
    noteNotFinite(*job.status, lane.pixel * job.samplesPerPixel + lane.sample);
    return;
  }
  forEachComponent(rtsl_color_components(job.launch),
                   [&](uint32_t i) { lane.sum[i] += double(color[i]); });
  if (hasSums(job))
    addSquare(job, lane, color);
}

/// Begins a pixel, or goes on with it.
inline void loadPixel(const RtslJob &job, Lane &lane) {
  const uint32_t components = rtsl_color_components(job.launch);
  if (!hasSums(job)) {
    lane.sample = lane.notFinite = 0;
    forEachComponent(components, [&](uint32_t i) { lane.sum[i] = 0; });
    return;
  }
  lane.sample = job.sums.taken[lane.pixel];
  lane.notFinite = lane.sample - job.sums.counted[lane.pixel];
  const double *sum = job.sums.colors + lane.pixel * components;
  forEachComponent(components, [&](uint32_t i) { lane.sum[i] = sum[i]; });
}

inline void storeSums(const RtslJob &job, const Lane &lane) {
  const uint32_t components = rtsl_color_components(job.launch);
  job.sums.taken[lane.pixel] = lane.sample;
  job.sums.counted[lane.pixel] = lane.sample - lane.notFinite;
  double *sum = job.sums.colors + lane.pixel * components;
  forEachComponent(components, [&](uint32_t i) { sum[i] = lane.sum[i]; });
}

/// The mean of the samples so far, black without any; or their sums.
inline void writePixel(const RtslJob &job, const Lane &lane) {
  if (hasSums(job)) {
    storeSums(job, lane);
    return;
  }
  uint32_t components = rtsl_color_components(job.launch);
  float *pixel = job.pixels + lane.pixel * components;
  uint32_t count = lane.sample - lane.notFinite;
  if (count == 0)
    countUp(&job.status->pixelsWithoutSample);
  forEachComponent(rtsl_color_components(job.launch), [&](uint32_t i) {
    // Of one sample it is that; a GPU takes long for a division.
    pixel[i] = count > 1 ? float(lane.sum[i] / double(count)) : count ? float(lane.sum[i]) : 0.0f;
  });
}

inline bool isToStop(const RtslJob &job) {
  return __atomic_load_n(&job.status->stop, __ATOMIC_RELAXED);
}

/// Stops rendering a pixel before it is complete.
inline void leavePixel(const RtslJob &job, Lane &lane) {
  countUp(&job.status->unfinishedPixels);
  __atomic_fetch_add(&job.status->unfinishedSamples, uint64_t(lane.sample), __ATOMIC_RELAXED);
  writePixel(job, lane);
  lane.sample = job.samplesPerPixel;
}

/// Takes the next free pixel that is not done. False if there is none, or the job is to stop.
inline bool takePixel(const RtslJob &job, Lane &lane) {
  do {
    lane.pixel = countUp(&job.status->nextPixel);
    const bool stops = isToStop(job); // a GPU does both at the same time
    if (lane.pixel >= uint64_t(job.width) * job.height)
      return false;
    if (stops) {
      countUp(&job.status->unfinishedPixels);
      return false;
    }
    loadPixel(job, lane);
  } while (lane.sample >= job.samplesPerPixel);
  return true;
}

/// Starts the next sample, in this pixel or another one.
inline void nextSample(const RtslJob &job, Lane &lane, Rays &rays) {
#ifndef __NVPTX__ // on a GPU each sample would wait for memory that all lanes share
  if (lane.sample != job.samplesPerPixel && isToStop(job))
    leavePixel(job, lane);
#endif
  if (lane.sample == job.samplesPerPixel && !takePixel(job, lane)) {
    rays.next = nothingLeft;
    return;
  }
  const auto pixel = uint32_t(lane.pixel); // no launch has more than 2^32
  startRays(rays, *job.launch, job.left + pixel % job.width, job.top + pixel / job.width,
            lane.sample);
}

inline void endSample(const RtslJob &job, Lane &lane, Rays &rays) {
  endSample(rays);
  addSample(job, lane, rays.ray.state.SampleColor);
  if (++lane.sample == job.samplesPerPixel)
    writePixel(job, lane);
}

/// rtsl_run_lane.
inline void runLane(const RtslJob &job, uint32_t number) {
  if (laneBytes(job.launch->maxDepth, job.launch->referenceChain) > job.laneBytes) {
    __atomic_store_n(&job.status->problem, RTSL_PROBLEM_STACK, __ATOMIC_RELAXED);
    return;
  }
  alignas(16) char local[localStackBytes];
  Rays rays;
  rays.bottom = hasLocalStack(job.launch, job.launch->maxDepth, job.launch->referenceChain)
                    ? local
                    : reinterpret_cast<char *>(job.lanes + number * job.laneBytes);
  Lane lane;
  lane.sample = job.samplesPerPixel; // no pixel yet
  bool hasPixel = false;
  rays.next = Rays::none;
  for (;;) {
    int32_t choice = vote(rays.next, nothingLeft);
    if (choice == nothingLeft)
      return;
    if (rays.next != choice)
      continue;
    if (choice == Rays::trace) {
      traceRay(rays);
    } else if (choice == Rays::none) {
      if (hasPixel)
        endSample(job, lane, rays);
      hasPixel = true;
      nextSample(job, lane, rays);
    } else {
      runState(rays, choice);
    }
  }
}

} // namespace rtsl::device
