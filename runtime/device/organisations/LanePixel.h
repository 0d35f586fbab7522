//===- LanePixel.h - a lane that renders all samples of a pixel -----------===//
//
// In programs with short shaders lanes take pixels instead of samples, if a slice has several for
// each lane. A lane adds the samples of its pixel itself, in the order of their numbers. So samples
// are not stored and read again, and what they have in common is done once: to take the pixel, and
// to find where it is.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/organisations/JobLaunch.h"
#include "runtime/device/organisations/SampleSums.h"
#include "runtime/device/organisations/Slice.h"

namespace rtsl::device {

inline bool lanesTakePixels(const RtslJob &job) {
  return rtsl_takes_pixels(launchOf(job)) && job.mayTakePixels;
}

struct LanePixel {
  Pixel pixel{none, 0};
  uint32_t sample = 0; // that is rendered
  PixelSum sum;

  static constexpr uint32_t none = 0xffffffffu;

  bool isThere() const { return pixel.x != none; }
};

inline LanePixel lanePixelAt(const RtslJob &job, uint32_t place) {
  const Pixel pixel = pixelAt(job, place);
  return {pixel, job.firstSample, sumBefore(job, pixel.number(job), 0)};
}

/// Goes on to the next sample in the lanes for which `goesOn` holds: adds that before, whose color
/// is `color`, and takes another pixel after the last one. There is none if no pixel is left. All
/// lanes of a warp call together.
inline void goToNextSample(const RtslJob &job, TakenSamples &taken, LanePixel &own, bool goesOn,
                           const float *color) {
  const uint32_t end = job.firstSample + job.sampleCount;
  bool needsPixel = goesOn;
  if (goesOn && own.isThere()) {
    const uint64_t number = own.pixel.number(job);
    addSample(job, own.sum, number, own.sample++, color);
    needsPixel = own.sample == end;
    if (needsPixel)
      putPixel(job, own.sum, number, end);
  }
  if (!warp::lanesWhere(needsPixel))
    return;
  const uint32_t place = takePlace(job, taken, needsPixel);
  if (needsPixel)
    own = place < placesOfSlice(job) ? lanePixelAt(job, place) : LanePixel();
}

} // namespace rtsl::device
