#include "runtime/render/passes/Adaptive.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace rtsl::runtime {

namespace {

/// A pixel takes this factor more samples than the ideal ones, so that the picture, not the last
/// pixel, decides when it is good enough.
constexpr double reserve = 1.25;

/// An estimate of the picture's error by the samples of one half. It depends on this half alone.
struct Estimate {
  std::vector<double> variances;    // of samples, by pixel
  double mean = 0;                  // of the picture
  double deviation = 0;             // the mean of the standard deviations
  double squaredError = 0;          // of the picture, with as many samples
  std::vector<std::uint32_t> taken; // samples in both halves, as far as they have decided
};

/// How far from a pixel its neighbours reach whose variances are averaged, if each has so many
/// samples: few samples of one pixel alone may miss rare bright ones altogether.
std::int64_t reachFor(std::uint32_t samples) {
  constexpr double enough = 1500; // samples
  constexpr std::int64_t nearest = 1, furthest = 6;
  const double across = std::sqrt(enough / std::max(samples, 1u));
  return std::clamp(std::int64_t(across / 2), nearest, furthest);
}

/// The sums of `count` values that are `stride` apart, and of up to `reach` neighbours of each.
void sumNeighbours(const double *values, double *sums, std::int64_t count, std::int64_t stride,
                   std::int64_t reach) {
  for (std::int64_t i = 0; i < count; ++i) {
    double sum = 0;
    for (std::int64_t k = std::max<std::int64_t>(i - reach, 0); k <= std::min(i + reach, count - 1);
         ++k)
      sum += values[k * stride];
    sums[i * stride] = sum;
  }
}

/// The means of the variances of each pixel and its neighbours.
std::vector<double> smoothed(const std::vector<double> &variances, std::int64_t width,
                             std::int64_t reach) {
  const std::int64_t height = std::int64_t(variances.size()) / width;
  std::vector<double> rows(variances.size()), sums(variances.size());
  for (std::int64_t y = 0; y < height; ++y)
    sumNeighbours(&variances[y * width], &rows[y * width], width, 1, reach);
  for (std::int64_t x = 0; x < width; ++x)
    sumNeighbours(&rows[x], &sums[x], height, width, reach);
  const auto neighbours = [reach](std::int64_t i, std::int64_t count) {
    return double(std::min(i + reach, count - 1) - std::max<std::int64_t>(i - reach, 0) + 1);
  };
  for (std::int64_t y = 0; y < height; ++y)
    for (std::int64_t x = 0; x < width; ++x)
      sums[y * width + x] /= neighbours(x, width) * neighbours(y, height);
  return sums;
}

Estimate estimateBy(std::uint32_t half, const PixelSums &sums, std::uint32_t width) {
  Estimate estimate;
  std::vector<double> variances(sums.pixels());
  std::uint32_t most = 0; // deciding samples of a pixel
  estimate.taken.resize(sums.pixels());
  for (std::size_t pixel = 0; pixel < sums.pixels(); ++pixel) {
    const std::size_t at = 2 * pixel + half;
    estimate.taken[pixel] = 2 * sums.deciding[at];
    most = std::max(most, sums.deciding[at]);
    const double count = sums.deciding[at];
    if (count < 2)
      continue;
    const double mean = sums.values[at] / count;
    estimate.mean += mean;
    variances[pixel] = std::max(0.0, sums.squares[at] / count - mean * mean) * count / (count - 1);
  }
  estimate.variances = smoothed(variances, width, reachFor(most));
  for (std::size_t pixel = 0; pixel < sums.pixels(); ++pixel) {
    estimate.deviation += std::sqrt(estimate.variances[pixel]);
    if (estimate.taken[pixel])
      estimate.squaredError += estimate.variances[pixel] / estimate.taken[pixel];
  }
  const auto pixels = double(sums.pixels());
  estimate.mean /= pixels;
  estimate.deviation /= pixels;
  estimate.squaredError /= pixels;
  return estimate;
}

/// Completes pixels of half `other`, about which `estimate` decides.
void close(std::uint32_t other, const Estimate &estimate, double error, PixelSums &sums) {
  const double wanted = error * error * estimate.mean * estimate.mean;
  const bool isDone = estimate.squaredError <= wanted;
  const double most = wanted / estimate.deviation / reserve; // standard deviation / samples
  for (std::size_t pixel = 0; pixel < sums.pixels(); ++pixel)
    if (isDone || std::sqrt(estimate.variances[pixel]) <= most * estimate.taken[pixel])
      sums.closed[pixel] |= 1u << other;
}

} // namespace

double closeHalves(PixelSums &sums, std::uint32_t width, double error) {
  double squaredErrors = 0, squaredMeans = 0;
  for (const std::uint32_t half : {0u, 1u}) {
    const Estimate estimate = estimateBy(half, sums, width);
    squaredErrors += estimate.squaredError;
    squaredMeans += estimate.mean * estimate.mean;
    close(1 - half, estimate, error, sums);
  }
  if (squaredErrors == 0)
    return 0;
  return std::sqrt(squaredErrors / squaredMeans);
}

} // namespace rtsl::runtime
