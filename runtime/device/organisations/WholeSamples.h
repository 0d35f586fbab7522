//===- WholeSamples.h - samples without states ----------------------------===//
//
// The megakernel of programs in which only `generate` sends rays, at one place: no ray waits for
// another one, so such a program is not split into states. A sample is one call of `generate`, in
// which the traversal and the methods of hits are inlined, and the warps choose no steps.
//
// Where samples take about the same time, a GPU has a thread for each of them, or for each pixel;
// otherwise warps take one sample after the other.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/engines/Programs.h"
#include "runtime/device/organisations/Job.h"
#include "runtime/device/organisations/JobLaunch.h"
#include "runtime/device/organisations/SampleSums.h"
#include "runtime/device/organisations/Slice.h"

namespace rtsl::device {

/// The color of a sample of the job, whose number is that of its half.
inline void renderSample(const RtslJob &job, Pixel pixel, uint32_t number, float *color) {
  generate(*launchOf(job), job.left + pixel.x, job.top + pixel.y, number, color);
}

/// Renders samples of the job until none is left. All lanes of a warp begin samples together.
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

//===----------------------------------------------------------------------===//
// Launches of a thread for each sample or pixel
//===----------------------------------------------------------------------===//

/// Called by each thread: the host finds in the status what the launch has done.
inline void noteLaunch(const RtslJob &job, uint32_t thread, bool hasSums) {
  if (thread != 0)
    return;
  job.status->nextSample = job.endOfLaunch;
  job.status->hasSums = hasSums;
}

/// Renders sample `thread` of the launch.
inline void renderSampleOfThread(const RtslJob &job, uint32_t thread) {
  noteLaunch(job, thread, false);
  const uint32_t sample = job.firstOfLaunch + thread;
  PixelSample found;
  if (sample >= job.endOfLaunch || !findSample(job, sample, found))
    return;
  float color[RTSL_MAX_COLOR];
  renderSample(job, found.pixel, found.number, color);
  storeColor(job, sample, color);
}

/// Renders pixel `thread` of the launch, whose samples are all of the slice: adds them in their
/// order.
inline void renderPixelOfThread(const RtslJob &job, uint32_t thread) {
  noteLaunch(job, thread, true);
  const uint32_t place = quotient(job.firstOfLaunch, job.bySampleCount) + thread;
  if (place >= quotient(job.endOfLaunch, job.bySampleCount))
    return;
  const Pixel pixel = pixelAt(job, place);
  const uint64_t number = pixel.number(job);
  const uint32_t end = job.firstSample + job.sampleCount;
  PixelSum sum = sumBefore(job, number, 0);
  for (uint32_t sample = job.firstSample; sample != end; ++sample) {
    float color[RTSL_MAX_COLOR];
    renderSample(job, pixel, sample, color);
    addSample(job, sum, number, sample, color);
  }
  putPixel(job, sum, number, end);
}

} // namespace rtsl::device
