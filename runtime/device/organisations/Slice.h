//===- Slice.h - the samples of a slice, and who takes them ---------------===//
//
// A slice of a rendering has `sampleCount` samples of each pixel. They are numbered pixel by pixel,
// and the pixels are in tiles of 8 x 4: the lanes of a warp, which take 32 samples with following
// numbers, begin with rays that are nearly the same, and mostly stay together.
//
// In an adaptive rendering the samples of a pixel are in two halves, and pixels that are complete
// take no part in a slice.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/organisations/Job.h"
#include "runtime/device/organisations/JobLaunch.h"
#include "runtime/device/ray/Abi.h"
#include "runtime/device/ray/Divisor.h"
#include "runtime/device/ray/Warp.h"

namespace rtsl::device {

struct Pixel {
  uint32_t x, y; // in the window of the job

  uint64_t number(const RtslJob &job) const { return uint64_t(y) * job.width + x; }
};

/// The halves of the samples in these sums, or 1.
inline uint32_t halvesOf(const RtslPixelSums &sums) {
  return sums.closed ? 2 : 1;
}

/// What the program calls sample `number` of a pixel: of two halves, the first has the even ones,
/// and the second the odd ones, and each is a sequence of its own.
inline uint32_t numberInHalf(uint32_t number, uint32_t halves) {
  return halves == 1 ? number : number / 2 + number % 2 * RTSL_SECOND_HALF;
}

constexpr uint32_t rowsOfBand = 4;

/// Sets the size of the window of a job, which has less than 2^32 pixels. If a band would have
/// more, the window is within the first one.
inline void setWindowSize(RtslJob &job, uint32_t width, uint32_t height) {
  const uint64_t band = uint64_t(rowsOfBand) * width;
  job.width = width;
  job.height = height;
  job.byBand = makeDivisor(band < 0xffffffffu ? uint32_t(band) : 0xffffffffu);
}

inline void setSampleCount(RtslJob &job, uint32_t ofPixel) {
  job.sampleCount = ofPixel;
  job.bySampleCount = makeDivisor(ofPixel);
}

/// Pixels are numbered in bands of four rows, and in a band column by column.
inline Pixel pixelAt(const RtslJob &job, uint32_t place) {
  if (job.places)
    place = job.places[place];
  const uint32_t band = quotient(place, job.byBand);
  const uint32_t inBand = place - band * rowsOfBand * job.width;
  const uint32_t left = job.height - band * rowsOfBand; // the last band may have fewer rows
  if (left >= rowsOfBand)
    return {inBand / rowsOfBand, band * rowsOfBand + inBand % rowsOfBand};
  const uint32_t x = left == 1 ? inBand : left == 2 ? inBand / 2 : inBand / 3;
  return {x, band * rowsOfBand + (inBand - x * left)};
}

inline uint32_t placesOfSlice(const RtslJob &job) {
  return job.places ? job.placeCount : job.width * job.height;
}

inline uint32_t samplesOfSlice(const RtslJob &job) {
  return placesOfSlice(job) * job.sampleCount;
}

/// A sample of a pixel, by what the program calls it.
struct PixelSample {
  Pixel pixel;
  uint32_t number;
};

/// Finds a sample of the slice. False if it was rendered before.
inline bool findSample(const RtslJob &job, uint32_t sample, PixelSample &found) {
  const uint32_t place = quotient(sample, job.bySampleCount);
  const uint32_t number = job.firstSample + (sample - place * job.sampleCount);
  found = {pixelAt(job, place), numberInHalf(number, halvesOf(job.sums))};
  return !job.taken || number >= job.taken[found.pixel.number(job)];
}

/// Whether the slice has stopped: lanes that see it take no samples any more.
inline bool isToStop(const RtslJob &job) {
  return __atomic_load_n(&job.status->stop, __ATOMIC_RELAXED);
}

/// The samples that a warp has taken. The lanes of a warp have the same.
struct TakenSamples {
  uint32_t next = 0, end = 0; // those that no lane has begun
  bool areLast = false;       // the slice has stopped

  static constexpr uint32_t none = 0xffffffffu;
};

#ifdef __NVPTX__

/// How many samples a warp takes next, after those up to `last`: one for each lane if few are left,
/// so that all warps end at about the same time.
inline uint32_t samplesAtOnce(const RtslJob &job, uint32_t last) {
  const uint32_t most = rtsl_samples_at_once(launchOf(job));
  if (most == lanesOfWarp)
    return most;
  const uint32_t lanes = __nvvm_read_ptx_sreg_nctaid_x() * __nvvm_read_ptx_sreg_ntid_x();
  return last + 16 * lanes < samplesOfSlice(job) ? most : lanesOfWarp;
}

/// The next number for each lane of the warp that needs one; all lanes call together. `take` takes
/// the next `atOnce` numbers of all warps, and gives the first one, or TakenSamples::none.
template <typename Take>
uint32_t takeNumber(const RtslJob &job, TakenSamples &taken, bool needsOne, uint32_t atOnce,
                    const Take &take) {
  const uint32_t waiting = warp::lanesWhere(needsOne);
  const auto count = uint32_t(__builtin_popcount(waiting));
  const auto before = uint32_t(__builtin_popcount(waiting & __nvvm_read_ptx_sreg_lanemask_lt()));
  const uint32_t left = taken.end - taken.next;
  uint32_t number = taken.next + before;
  taken.next += count;
  if (count <= left)
    return number;
  uint32_t first = TakenSamples::none, stops = 0;
  if (needsOne && before == 0 && !taken.areLast) { // a GPU does both at the same time
    first = take();
    stops = isToStop(job);
  }
  const int leader = __builtin_ctz(waiting);
  first = uint32_t(warp::valueOf(int32_t(first), leader));
  taken.areLast |= warp::lanesWhere(stops) != 0;
  if (first == TakenSamples::none) {
    taken.next = taken.end = 0;
    return before < left ? number : TakenSamples::none;
  }
  taken.next = first + (count - left);
  taken.end = first + atOnce;
  return before < left ? number : first + (before - left);
}

/// The next sample for each lane of the warp that needs one; all lanes call together. The number is
/// not below samplesOfSlice(job) if none is left.
inline uint32_t takeSample(const RtslJob &job, TakenSamples &taken, bool needsOne) {
  const uint32_t atOnce = samplesAtOnce(job, taken.end);
  return takeNumber(job, taken, needsOne, atOnce, [&] {
    return uint32_t(
        __atomic_fetch_add(&job.status->nextSample, uint64_t(atOnce), __ATOMIC_RELAXED));
  });
}

/// The same for places, of pixels whose samples are all taken: not below placesOfSlice(job) if none
/// is left.
inline uint32_t takePlace(const RtslJob &job, TakenSamples &taken, bool needsOne) {
  return takeNumber(job, taken, needsOne, lanesOfWarp, [&] {
    const uint64_t sample = __atomic_fetch_add(
        &job.status->nextSample, uint64_t(lanesOfWarp) * job.sampleCount, __ATOMIC_RELAXED);
    return sample < samplesOfSlice(job) ? quotient(uint32_t(sample), job.bySampleCount)
                                        : TakenSamples::none;
  });
}

/// The next sample for each lane of the warp that needs one, without any in reserve; all lanes call
/// together, and at least one needs one. TakenSamples::none if the slice has stopped.
inline uint32_t takeOneSample(const RtslJob &job, bool needsOne) {
  const uint32_t waiting = warp::lanesWhere(needsOne);
  const int leader = __builtin_ctz(waiting);
  uint32_t first = TakenSamples::none;
  if (int(__nvvm_read_ptx_sreg_laneid()) == leader && !isToStop(job))
    first = uint32_t(__atomic_fetch_add(&job.status->nextSample,
                                        uint64_t(__builtin_popcount(waiting)), __ATOMIC_RELAXED));
  first = uint32_t(warp::valueOf(int32_t(first), leader));
  if (first == TakenSamples::none)
    return first;
  return first + uint32_t(__builtin_popcount(waiting & __nvvm_read_ptx_sreg_lanemask_lt()));
}

#else

inline uint32_t takeSample(const RtslJob &job, TakenSamples &taken, bool) {
  constexpr uint32_t atOnce = 4; // of a cache line of colors
  if (taken.next == taken.end) {
    if (isToStop(job))
      return TakenSamples::none;
    taken.next =
        uint32_t(__atomic_fetch_add(&job.status->nextSample, uint64_t(atOnce), __ATOMIC_RELAXED));
    taken.end = taken.next + atOnce;
  }
  return taken.next++;
}

inline uint32_t takePlace(const RtslJob &job, TakenSamples &, bool needsOne) {
  if (!needsOne || isToStop(job))
    return TakenSamples::none;
  const uint64_t sample =
      __atomic_fetch_add(&job.status->nextSample, uint64_t(job.sampleCount), __ATOMIC_RELAXED);
  return sample < samplesOfSlice(job) ? quotient(uint32_t(sample), job.bySampleCount)
                                      : TakenSamples::none;
}

inline uint32_t takeOneSample(const RtslJob &job, bool) {
  if (isToStop(job))
    return TakenSamples::none;
  return uint32_t(__atomic_fetch_add(&job.status->nextSample, uint64_t(1), __ATOMIC_RELAXED));
}

#endif

} // namespace rtsl::device
