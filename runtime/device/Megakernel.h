//===- Megakernel.h - a whole scene as one program ------------------------===//
//
// The machine of Machine.h with its traversal, for as many lanes as there are. A lane renders a
// pixel after the other; the lanes of a warp vote for what to run next: the ray's traversal, one of
// the states, or the beginning of another sample. Those who want something else wait. How they
// vote changes nothing but time: a lane's rays are its own.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/Abi.h"
#include "runtime/device/Machine.h"
#include "runtime/device/Warp.h"

namespace rtsl::device {

/// A lane's memory begins with this; its stack of rays follows.
struct alignas(16) Lane {
  double sum[RTSL_MAX_COLOR]; // of the pixel's samples, in their order
  uint64_t pixel;
  uint32_t sample; // the next one of the pixel
};

/// What a lane wants that has found no pixel. Beside the values of Rays::next.
constexpr int32_t nothingLeft = -2;

inline uint64_t laneBytes(uint32_t maxDepth, uint32_t referenceChain) {
  return sizeof(Lane) + stackSize(maxDepth, referenceChain);
}

/// Adds the color of a sample that is over to its pixel. A color that is not finite counts as black,
/// for it would take the whole pixel with it.
inline void addSample(const RtslJob &job, Lane &lane, const float *color) {
  uint32_t components = rtsl_color_components(job.launch);
  bool isNotFinite = false;
  for (uint32_t i = 0; i < components; ++i)
    isNotFinite |= !(absolute(color[i]) < infinity);
  if (isNotFinite) {
    countUp(&job.status->samplesNotFinite);
    return;
  }
  for (uint32_t i = 0; i < components; ++i)
    lane.sum[i] += double(color[i]);
}

inline void writePixel(const RtslJob &job, const Lane &lane) {
  uint32_t components = rtsl_color_components(job.launch);
  float *pixel = job.pixels + lane.pixel * components;
  for (uint32_t i = 0; i < components; ++i)
    pixel[i] = float(lane.sum[i] / double(job.samplesPerPixel));
}

/// Takes a pixel that nobody has. False if there is none, or the job is to stop.
inline bool takePixel(const RtslJob &job, Lane &lane) {
  if (__atomic_load_n(&job.status->stop, __ATOMIC_RELAXED))
    return false;
  lane.pixel = countUp(&job.status->nextPixel);
  lane.sample = 0;
  for (uint32_t i = 0; i < rtsl_color_components(job.launch); ++i)
    lane.sum[i] = 0;
  return lane.pixel < uint64_t(job.launch->width) * job.launch->height;
}

/// Starts the next sample, of this pixel or of another one.
inline void nextSample(const RtslJob &job, Lane &lane, Rays &rays) {
  if (lane.sample == job.samplesPerPixel && !takePixel(job, lane)) {
    rays.next = nothingLeft;
    return;
  }
  uint32_t width = job.launch->width;
  startRays(rays, *job.launch, uint32_t(lane.pixel % width), uint32_t(lane.pixel / width),
            lane.sample);
}

inline void endSample(const RtslJob &job, Lane &lane, Rays &rays) {
  endSample(rays);
  addSample(job, lane, rays.bottom->state.SampleColor);
  if (++lane.sample == job.samplesPerPixel)
    writePixel(job, lane);
}

/// rtsl_run_lane.
inline void runLane(const RtslJob &job, uint32_t number) {
  if (laneBytes(job.launch->maxDepth, job.launch->referenceChain) > job.laneBytes) {
    __atomic_store_n(&job.status->problem, RTSL_PROBLEM_STACK, __ATOMIC_RELAXED);
    return;
  }
  Lane &lane = *reinterpret_cast<Lane *>(job.lanes + number * job.laneBytes);
  lane.sample = job.samplesPerPixel; // of no pixel
  Rays rays;
  rays.bottom = reinterpret_cast<Level *>(&lane + 1);
  nextSample(job, lane, rays);
  for (;;) {
    int32_t choice = vote(rays.next, nothingLeft);
    if (choice == nothingLeft)
      return;
    if (rays.next != choice)
      continue;
    if (choice == Rays::trace) {
      traceRay(rays);
    } else if (choice == Rays::none) {
      endSample(job, lane, rays);
      nextSample(job, lane, rays);
    } else {
      runState(rays, choice);
    }
  }
}

} // namespace rtsl::device
