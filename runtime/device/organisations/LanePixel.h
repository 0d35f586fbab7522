//===- LanePixel.h - a lane that renders all samples of a pixel -----------===//
//
// In programs with short shaders lanes take pixels instead of samples, if a slice has several for
// each lane. A lane adds the samples of its pixel itself, in the order of their numbers. So samples
// are not stored and read again, and what they have in common is done once: to take the pixel, and
// to find where it is.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/engines/Machine.h"
#include "runtime/device/organisations/SampleSums.h"
#include "runtime/device/organisations/Schedule.h"
#include "runtime/device/organisations/Slice.h"

namespace rtsl::device {

inline bool lanesTakePixels(const RtslJob &job) {
  return rtsl_takes_pixels(job.launch) && job.mayTakePixels;
}

struct LanePixel {
  Pixel pixel{none, 0};
  uint32_t sample = 0; // that is rendered, or will be the next
  PixelSum sum;

  static constexpr uint32_t none = 0xffffffffu;

  bool isThere() const { return pixel.x != none; }
};

inline LanePixel lanePixelAt(const RtslJob &job, uint32_t place) {
  const Pixel pixel = pixelAt(job, place);
  return {pixel, job.firstSample, sumBefore(job, pixel.number(job), 0)};
}

/// The step of the lanes that begin a sample: they end that before, and take another pixel after
/// the last one. All lanes of a warp call together.
inline void stepToNextSample(const RtslJob &job, TakenSamples &taken, LanePixel &own,
                             bool takesPart, Rays &rays) {
  const uint32_t end = job.firstSample + job.sampleCount;
  bool needsPixel = takesPart;
  if (takesPart && own.isThere()) {
    endSample(rays);
    const uint64_t number = own.pixel.number(job);
    addSample(job, own.sum, number, own.sample++, rays.ray.state.SampleColor);
    needsPixel = own.sample == end;
    if (needsPixel) {
      putSum(job, own.sum, number, 0, end);
      if (job.sums.colors)
        job.sums.taken[number] = end;
    }
  }
  if (warp::lanesWhere(needsPixel)) {
    const uint32_t place = takePlace(job, taken, needsPixel);
    if (needsPixel)
      own = place < placesOfSlice(job) ? lanePixelAt(job, place) : LanePixel();
  }
  if (!takesPart)
    return;
  if (own.isThere())
    startRays(rays, *job.launch, job.left + own.pixel.x, job.top + own.pixel.y, own.sample);
  else
    rays.next = Step::nothing;
}

} // namespace rtsl::device
