//===- WholeSamples.h - samples without states ----------------------------===//
//
// The megakernel of programs in which only `generate` sends rays, at one place: no ray waits for
// another one, so such a program is not split into states. A sample is one call of `generate`, in
// which the traversal and the methods of hits are inlined, and the warps choose no steps.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/engines/Programs.h"
#include "runtime/device/organisations/Job.h"
#include "runtime/device/organisations/LanePixel.h"

namespace rtsl::device {

/// The color of a sample of the job, whose number is that of its half.
inline void renderSample(const RtslJob &job, Pixel pixel, uint32_t number, float *color) {
  generate(*job.launch, job.left + pixel.x, job.top + pixel.y, number, color);
}

/// Renders pixels of the job until none is left. All lanes of a warp begin samples together.
inline void runWholePixels(const RtslJob &job) {
  __atomic_store_n(&job.status->hasSums, 1, __ATOMIC_RELAXED);
  TakenSamples taken;
  LanePixel own;
  float color[RTSL_MAX_COLOR];
  for (bool isLeft = true;;) {
    goToNextSample(job, taken, own, isLeft, color);
    isLeft = own.isThere();
    if (!warp::lanesWhere(isLeft))
      return;
    if (isLeft)
      renderSample(job, own.pixel, own.sample, color);
  }
}

/// The same for samples.
inline void runWholeSamples(const RtslJob &job) {
  TakenSamples taken;
  for (bool isLeft = true;;) {
    const uint32_t sample = takeSample(job, taken, isLeft);
    isLeft = isLeft && sample < samplesOfSlice(job);
    if (!warp::lanesWhere(isLeft))
      return;
    PixelSample found;
    if (!isLeft || !findSample(job, sample, found))
      continue;
    float color[RTSL_MAX_COLOR];
    renderSample(job, found.pixel, found.number, color);
    storeColor(job, sample, color);
  }
}

} // namespace rtsl::device
