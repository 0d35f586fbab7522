#include "runtime/render/PixelSums.h"

#include "support/Error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>

namespace rtsl::runtime {

PixelSums PixelSums::make(std::uint64_t pixels, std::uint32_t components) {
  PixelSums sums;
  try {
    sums.colors.resize(pixels * components);
    sums.squares.resize(pixels);
    sums.counted.resize(pixels);
    sums.taken.resize(pixels);
  } catch (const std::bad_alloc &) {
    throw Error(ErrorCode::OutOfMemory, "not enough memory for the sums of the pixels");
  }
  return sums;
}

RtslPixelSums PixelSums::pointers() {
  return {colors.data(), squares.data(), counted.data(), taken.data()};
}

SampleCounts countSamples(const PixelSums &sums) {
  SampleCounts counts;
  if (sums.isEmpty())
    return counts;
  counts.least = counts.most = sums.taken.front();
  for (std::size_t pixel = 0; pixel < sums.pixels(); ++pixel) {
    const std::uint32_t taken = sums.taken[pixel], counted = sums.counted[pixel];
    counts.samples += taken;
    counts.notFinite += taken - counted;
    counts.pixelsWithoutSample += taken > 0 && counted == 0;
    counts.least = std::min(counts.least, taken);
    counts.most = std::max(counts.most, taken);
  }
  return counts;
}

void resolve(const PixelSums &sums, float withoutSample, Image &picture) {
  const std::uint32_t components = picture.channels;
  for (std::size_t pixel = 0; pixel < sums.pixels(); ++pixel)
    for (std::uint32_t c = 0; c < components; ++c) {
      const std::size_t i = pixel * components + c;
      picture.pixels[i] = sums.counted[pixel] ? float(sums.colors[i] / double(sums.counted[pixel]))
                          : sums.taken[pixel] ? withoutSample
                                              : 0.0f;
    }
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
