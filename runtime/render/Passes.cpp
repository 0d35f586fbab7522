#include "runtime/render/Passes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace rtsl::runtime {

double relativeError(const PixelSums &sums, std::uint32_t components) {
  double mean = 0, variance = 0;
  std::uint64_t pixels = 0;
  for (std::size_t pixel = 0; pixel < sums.counted.size(); ++pixel) {
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

std::uint32_t nextMeasurement(std::uint32_t samples) {
  std::uint64_t next = 16;
  while (next <= samples)
    next += next / 4;
  return std::uint32_t(std::min<std::uint64_t>(next, 0xffffffffu));
}

} // namespace rtsl::runtime
