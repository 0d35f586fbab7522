//===- SampleSums.h - adds the samples of a slice to the pixels -----------===//
//
// Lanes finish samples in any order, and a sum of floats depends on the order. So they store each
// sample, and afterwards the samples of a pixel are added in the order of their numbers.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/organisations/Job.h"
#include "runtime/device/organisations/JobLaunch.h"
#include "runtime/device/organisations/Slice.h"
#include "runtime/device/ray/Abi.h"
#include "runtime/device/ray/Color.h"
#include "runtime/device/ray/Vector.h"

namespace rtsl::device {

/// Stores a sample of the slice, if samples are wanted.
inline void storeColor(const RtslJob &job, uint32_t sample, const float *color) {
  const uint32_t components = rtsl_color_components(launchOf(job));
  if (job.samples)
    copyColor(job.samples + uint64_t(sample) * components, color, components);
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

inline bool isFiniteColor(const float *color, uint32_t components) {
  bool isFinite = true;
  forEachComponent(components, [&](uint32_t i) { isFinite &= absolute(color[i]) < infinity; });
  return isFinite;
}

/// The sums of a pixel, or of a half of it, while samples are added.
struct PixelSum {
  double color[RTSL_MAX_COLOR];
  double squares, values;
  uint32_t counted, deciding;
  bool isClosed = false;   // `color` is complete,
  bool hasDecided = false; // and `squares` and `values` are
};

/// A sample that is not finite is left out of the pixel's mean, which would not be finite either.
__attribute__((cold, noinline)) inline void leaveOut(RtslStatus &status, uint64_t pixel,
                                                     uint32_t number) {
  countUp(&status.samplesNotFinite);
  noteNotFinite(status, pixel << 32 | number);
}

/// Adds sample `number` to its pixel.
inline void addSample(const RtslJob &job, PixelSum &sum, uint64_t pixel, uint32_t number,
                      const float *color) {
  const uint32_t components = rtsl_color_components(launchOf(job));
  if (!isFiniteColor(color, components)) {
    leaveOut(*job.status, pixel, number);
    return;
  }
  if (!sum.isClosed) {
    ++sum.counted;
    forEachComponent(components, [&](uint32_t i) { sum.color[i] += double(color[i]); });
  }
  if (job.sums.squares && !sum.hasDecided) {
    double value = 0;
    forEachComponent(components, [&](uint32_t i) { value += double(color[i]); });
    value /= double(components);
    ++sum.deciding;
    sum.values += value;
    sum.squares += value * value;
  }
}

/// The mean of the finite samples, black without any.
inline void writeMean(const RtslJob &job, const PixelSum &sum, uint64_t pixel, uint32_t taken) {
  const uint32_t components = rtsl_color_components(launchOf(job));
  float *mean = job.pixels + pixel * components;
  forEachComponent(components, [&](uint32_t i) {
    mean[i] = sum.counted > 1 ? float(sum.color[i] / double(sum.counted))
              : sum.counted   ? float(sum.color[i])
                              : 0.0f;
  });
  if (sum.counted == 0 && taken == job.samplesPerPixel)
    countUp(&job.status->pixelsWithoutSample);
}

/// The sums of the samples before the slice, of half `half`.
inline PixelSum sumBefore(const RtslJob &job, uint64_t pixel, uint32_t half) {
  const uint32_t components = rtsl_color_components(launchOf(job));
  const RtslPixelSums &sums = job.sums;
  const uint64_t at = pixel * halvesOf(sums) + half;
  PixelSum sum;
  const double *colors = sums.colors ? sums.colors + at * components : nullptr;
  forEachComponent(components, [&](uint32_t i) { sum.color[i] = colors ? colors[i] : 0; });
  sum.squares = sums.squares ? sums.squares[at] : 0;
  sum.counted = sums.colors ? sums.counted[at] : 0;
  sum.values = sum.deciding = 0;
  if (sums.closed) {
    sum.values = sums.values[at];
    sum.deciding = sums.deciding[at];
    sum.isClosed = sums.closed[pixel] >> half & 1;
    sum.hasDecided = sums.closed[pixel] >> (1 - half) & 1;
  }
  return sum;
}

inline void storeSum(const RtslJob &job, const PixelSum &sum, uint64_t pixel, uint32_t half) {
  const uint32_t components = rtsl_color_components(launchOf(job));
  const RtslPixelSums &sums = job.sums;
  const uint64_t at = pixel * halvesOf(sums) + half;
  double *colors = sums.colors + at * components;
  forEachComponent(components, [&](uint32_t i) { colors[i] = sum.color[i]; });
  if (sums.squares)
    sums.squares[at] = sum.squares;
  sums.counted[at] = sum.counted;
  if (sums.closed) {
    sums.values[at] = sum.values;
    sums.deciding[at] = sum.deciding;
  }
}

/// Leaves the sum of a pixel, or of a half of it, that has all samples below `taken`, where the job
/// wants it.
inline void putSum(const RtslJob &job, const PixelSum &sum, uint64_t pixel, uint32_t half,
                   uint32_t taken) {
  if (job.sums.colors)
    storeSum(job, sum, pixel, half);
  if (job.pixels)
    writeMean(job, sum, pixel, taken);
}

/// The same of a pixel without halves, which has those samples from now on.
inline void putPixel(const RtslJob &job, const PixelSum &sum, uint64_t pixel, uint32_t taken) {
  putSum(job, sum, pixel, 0, taken);
  if (job.sums.colors)
    job.sums.taken[pixel] = taken;
}

/// Adds samples `number` to `end` - 1 of the pixel, which are all in one half: four at a time where
/// 16 bytes can be loaded at once. Each lane of a warp reads other cache lines, and a load takes as
/// long as its number of lines, however few bytes it reads of them.
inline void addSamplesInOrder(const RtslJob &job, PixelSum &sum, uint64_t pixel, uint32_t number,
                              uint32_t end, const float *colors) {
  const uint32_t components = rtsl_color_components(launchOf(job));
  constexpr uint32_t inGroup = 4, groupBytes = inGroup * sizeof(float);
  while (number < end) {
    if (end - number < inGroup || reinterpret_cast<uintptr_t>(colors) % groupBytes != 0) {
      addSample(job, sum, pixel, number++, colors);
      colors += components;
      continue;
    }
    alignas(groupBytes) float group[inGroup * RTSL_MAX_COLOR];
    forEachComponent(components, [&](uint32_t i) {
      __builtin_memcpy(group + inGroup * i,
                       __builtin_assume_aligned(colors + inGroup * i, groupBytes), groupBytes);
    });
#ifdef __clang__
#pragma clang loop unroll(full)
#endif
    for (uint32_t i = 0; i < inGroup; ++i)
      addSample(job, sum, pixel, number + i, group + i * components);
    number += inGroup;
    colors += inGroup * components;
  }
}

/// Adds the first `count` samples that the slice has of the pixel at `place`.
inline void addSamplesOfPixel(const RtslJob &job, uint32_t place, uint32_t count) {
  const uint32_t components = rtsl_color_components(launchOf(job));
  const uint32_t halves = halvesOf(job.sums);
  const uint64_t pixel = pixelAt(job, place).number(job);
  const float *samples = job.samples + uint64_t(place) * job.sampleCount * components;
  const uint32_t before = job.sums.colors ? job.sums.taken[pixel] : job.firstSample;
  const uint32_t wanted = job.firstSample + count;
  const uint32_t end = wanted > before ? wanted : before; // those before are added already
  for (uint32_t half = 0; half < halves; ++half) {
    PixelSum sum = sumBefore(job, pixel, half);
    if (halves == 1)
      addSamplesInOrder(job, sum, pixel, before, end,
                        samples + uint64_t(before - job.firstSample) * components);
    else
      for (uint32_t number = before + (before + half) % halves; number < end; number += halves)
        addSample(job, sum, pixel, numberInHalf(number, halves),
                  samples + uint64_t(number - job.firstSample) * components);
    putSum(job, sum, pixel, half, end);
  }
  if (job.sums.colors)
    job.sums.taken[pixel] = end;
}

/// To be run after all lanes of the job: adds the samples that were taken to the sums, and computes
/// the means if these are wanted; without sums, of the slice alone. Each of `lanes` lanes adds
/// those of its share of the pixels.
inline void addSamples(const RtslJob &job, uint32_t lane, uint32_t lanes) {
  const uint64_t next = job.status->nextSample, all = samplesOfSlice(job);
  const auto taken = uint32_t(next < all ? next : all);
  for (uint64_t place = lane; place * job.sampleCount < taken; place += lanes) {
    const uint32_t left = taken - uint32_t(place) * job.sampleCount;
    addSamplesOfPixel(job, uint32_t(place), left < job.sampleCount ? left : job.sampleCount);
  }
}

} // namespace rtsl::device
