#include "runtime/render/passes/PixelSums.h"

#include "support/Error.h"
#include "support/ErrorMessages.h"
#include "support/Parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>

namespace rtsl::runtime {

PixelSums PixelSums::make(std::uint64_t pixels, std::uint32_t components, bool isAdaptive,
                          bool isMeasured) {
  PixelSums sums;
  const std::uint64_t halves = isAdaptive ? 2 * pixels : pixels;
  try {
    sums.colors.resize(halves * components);
    if (isMeasured)
      sums.squares.resize(halves);
    sums.counted.resize(halves);
    sums.taken.resize(pixels);
    if (isAdaptive) {
      sums.values.resize(halves);
      sums.deciding.resize(halves);
      sums.closed.resize(pixels);
    }
  } catch (const std::bad_alloc &) {
    throw Error(message::noMemoryForPixelSums());
  }
  return sums;
}

RtslPixelSums PixelSums::pointers() {
  RtslPixelSums sums{};
  sums.colors = colors.data();
  sums.squares = isMeasured() ? squares.data() : nullptr;
  sums.counted = counted.data();
  sums.taken = taken.data();
  if (isAdaptive()) {
    sums.values = values.data();
    sums.deciding = deciding.data();
    sums.closed = closed.data();
  }
  return sums;
}

/// The number of samples of a pixel. Both halves take samples until both are complete, so the
/// larger count of a half includes all that were taken.
static std::uint32_t finiteSamples(const PixelSums &sums, std::size_t pixel) {
  if (!sums.isAdaptive())
    return sums.counted[pixel];
  return std::max(sums.counted[2 * pixel], sums.deciding[2 * pixel]) +
         std::max(sums.counted[2 * pixel + 1], sums.deciding[2 * pixel + 1]);
}

SampleCounts countSamples(const PixelSums &sums) {
  SampleCounts counts;
  std::uint32_t leastOpen = std::numeric_limits<std::uint32_t>::max(), mostOpen = 0, most = 0;
  for (std::size_t pixel = 0; pixel < sums.pixels(); ++pixel) {
    const std::uint32_t taken = sums.taken[pixel], finite = finiteSamples(sums, pixel);
    counts.samples += taken;
    counts.notFinite += taken - finite;
    counts.pixelsWithoutSample += taken > 0 && finite == 0;
    most = std::max(most, taken);
    if (!sums.isOpen(pixel))
      continue;
    ++counts.openPixels;
    leastOpen = std::min(leastOpen, taken);
    if (taken > mostOpen) {
      mostOpen = taken;
      counts.pixelsWithMost = 0;
    }
    counts.pixelsWithMost += taken == mostOpen;
  }
  counts.least = counts.openPixels ? leastOpen : most;
  counts.most = counts.openPixels ? mostOpen : most;
  return counts;
}

void resolve(const PixelSums &sums, float withoutSample, Image &picture, unsigned threads) {
  constexpr std::size_t atOnce = 4096;
  const std::uint32_t components = picture.channels, halves = sums.halves();
  forEachInParallel(threads, sums.pixels(), atOnce, [&](std::size_t pixel) {
    for (std::uint32_t c = 0; c < components; ++c) {
      double means = 0;
      std::uint32_t count = 0;
      for (std::size_t half = pixel * halves; half < (pixel + 1) * halves; ++half)
        if (sums.counted[half]) {
          means += sums.colors[half * components + c] / double(sums.counted[half]);
          ++count;
        }
      picture.pixels[pixel * components + c] = count               ? float(means / count)
                                               : sums.taken[pixel] ? withoutSample
                                                                   : 0.0f;
    }
  });
}

double relativeError(const PixelSums &sums, std::uint32_t components) {
  double mean = 0, variance = 0;
  std::uint64_t pixels = 0;
  for (std::size_t pixel = 0; pixel < sums.pixels(); ++pixel) {
    const double count = sums.counted[pixel];
    if (count < 2)
      continue;
    double sum = 0;
    for (std::uint32_t c = 0; c < components; ++c)
      sum += sums.colors[pixel * components + c];
    const double value = sum / components / count;
    mean += value;
    variance += std::max(0.0, (sums.squares[pixel] / count - value * value) / (count - 1));
    ++pixels;
  }
  if (pixels == 0)
    return std::numeric_limits<double>::infinity();
  if (variance == 0)
    return 0;
  return std::sqrt(variance / double(pixels)) / std::abs(mean / double(pixels));
}

} // namespace rtsl::runtime
