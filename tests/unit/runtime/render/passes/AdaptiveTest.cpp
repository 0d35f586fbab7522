// Adaptive renderings are right on average, have less noise where they take as many samples, and
// can be interrupted anywhere. The host's megakernel runs a program whose samples have known laws.
#include "runtime/render/passes/Adaptive.h"

#include "runtime/device/organisations/Slice.h"
#include "runtime/device/ray/Random.h"
#include "runtime/render/HostMegakernel.h"
#include "support/Error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace rtsl::runtime;
namespace device = rtsl::device;

namespace {

constexpr std::uint32_t width = 48, height = 40;

/// A sample of mean 1: bright with this probability, otherwise black. Its variance is
/// 1 / probability - 1.
double probabilityAt(std::uint32_t x, std::uint32_t) {
  return x < 12 ? 1.0 : x < 24 ? 0.5 : x < 36 ? 1.0 / 8 : 1.0 / 64;
}

float drawn(std::uint32_t x, std::uint32_t y, std::uint32_t number, std::uint32_t seed) {
  const double probability = probabilityAt(x, y);
  const std::uint32_t half = number / RTSL_SECOND_HALF, index = number % RTSL_SECOND_HALF;
  const device::Words4 words = device::hash4(x, y, index, 2 * seed + half);
  return device::unitFloat(words.x) < probability ? float(1 / probability) : 0;
}

void draw(const RtslJob *job, std::uint32_t) {
  while (!__atomic_load_n(&job->status->stop, __ATOMIC_RELAXED)) {
    const std::uint64_t sample = __atomic_fetch_add(&job->status->nextSample, 1, __ATOMIC_RELAXED);
    if (sample >= device::samplesOfSlice(*job))
      return;
    const auto place = std::uint32_t(sample / job->sampleCount);
    const device::Pixel pixel = device::pixelAt(*job, place);
    const std::uint32_t number = std::uint32_t(sample % job->sampleCount) + job->firstSample;
    if (job->taken && number < job->taken[pixel.number(*job)])
      continue;
    const std::uint32_t halves = device::halvesOf(job->sums);
    std::fill_n(job->samples + 3 * sample, 3,
                drawn(pixel.x, pixel.y, device::numberInHalf(number, halves), job->launch->seed));
  }
}

FlatScene emptyScene() {
  RtslLaunch launch{};
  launch.colorComponents = 3;
  FlatScene scene;
  scene.bytes.resize(sizeof launch);
  scene.setLaunch(launch);
  return scene;
}

RenderOptions options(std::uint32_t seed, std::uint32_t samples = 1u << 20) {
  RenderOptions options;
  options.width = width;
  options.height = height;
  options.samplesPerPixel = samples;
  options.maxDepth = 0;
  options.seed = seed;
  options.isAdaptive = true;
  return options;
}

PassOptions withError(double error) {
  PassOptions passes;
  passes.error = error;
  return passes;
}

Image render(const RenderOptions &options, const PassOptions &passes, PartialRendering &rendering,
             RenderStatistics *statistics = nullptr) {
  MegakernelCode code;
  code.laneBytes = [](std::uint32_t, std::uint32_t) { return std::uint64_t(100); };
  code.runLane = draw;
  return HostMegakernel(code, emptyScene(), options)
      .renderInPasses(passes, nullptr, rendering, statistics);
}

double meanOf(const std::vector<double> &values) {
  double sum = 0;
  for (const double value : values)
    sum += value;
  return sum / double(values.size());
}

/// How many standard errors the mean of independent values is from `expected`.
double deviationOfMean(const std::vector<double> &values, double expected) {
  const double mean = meanOf(values);
  double squares = 0;
  for (const double value : values)
    squares += (value - mean) * (value - mean);
  const auto count = double(values.size());
  return (mean - expected) / std::sqrt(squares / (count * (count - 1)));
}

double meanOfPicture(const Image &image) {
  double sum = 0;
  for (std::size_t i = 0; i < image.pixels.size(); i += 3)
    sum += image.pixels[i];
  return sum / (width * height);
}

/// Pairs of a number of samples and their mean, and how they are correlated: in standard errors
/// of the correlation of pairs that have nothing to do with one another.
struct Pairs {
  double count = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;

  void add(double samples, double mean) {
    const double of = std::log(samples);
    count += 1;
    x += of;
    y += mean;
    xx += of * of;
    yy += mean * mean;
    xy += of * mean;
  }
  double correlation() const {
    const double covariance = xy - x * y / count;
    return covariance / std::sqrt((xx - x * x / count) * (yy - y * y / count)) * std::sqrt(count);
  }
};

} // namespace

TEST(Adaptive, PicturesAreRightOnAverage) {
  std::vector<double> means;
  Pairs shown, deciding; // of the pixels where bright samples are rare
  for (std::uint32_t seed = 1; seed <= 60; ++seed) {
    PartialRendering rendering;
    means.push_back(meanOfPicture(render(options(seed), withError(0.3), rendering)));
    const PixelSums &sums = rendering.sums;
    for (std::size_t half = 0; half < sums.values.size(); ++half)
      if (half / 2 % width >= 36) {
        shown.add(sums.counted[half], sums.colors[3 * half] / sums.counted[half]);
        deciding.add(sums.deciding[half], sums.values[half] / sums.deciding[half]);
      }
  }
  EXPECT_LT(std::abs(deviationOfMean(means, 1)), 3.5) << meanOf(means);
  EXPECT_LT(std::abs(shown.correlation()), 4);
  EXPECT_GT(deciding.correlation(), 8); // pixels that have met no bright samples end early
}

TEST(Adaptive, SamplesGoWhereTheDeviationIs) {
  PartialRendering rendering;
  RenderStatistics statistics;
  const Image image = render(options(5), withError(0.02), rendering, &statistics);
  EXPECT_EQ(statistics.openPixels, 0u);
  EXPECT_FALSE(statistics.isUnfinished);
  EXPECT_LE(rendering.state.error, 0.02);
  // Of columns whose neighbours are like them.
  const auto samplesAt = [&](std::uint32_t x) {
    double sum = 0;
    for (std::uint32_t y = 0; y < height; ++y)
      sum += rendering.sums.taken[y * width + x];
    return sum / height;
  };
  EXPECT_LT(samplesAt(2), 30);
  // The standard deviations are as 1 : sqrt(7) : sqrt(63); there is a measurement every 25 %.
  EXPECT_NEAR(std::log(samplesAt(30) / samplesAt(18)), std::log(std::sqrt(7.0)), 0.3);
  EXPECT_GT(samplesAt(42) / samplesAt(30), 1.7); // less than 3: the picture was good enough

  // The error is what it is said to be.
  double squares = 0;
  for (std::size_t i = 0; i < image.pixels.size(); i += 3)
    squares += (image.pixels[i] - 1) * (image.pixels[i] - 1);
  EXPECT_NEAR(std::sqrt(squares / (width * height)), rendering.state.error, 0.002);
}

TEST(Adaptive, FewerSamplesGiveTheSameError) {
  PartialRendering adaptive, even;
  RenderStatistics ofAdaptive, ofEven;
  render(options(6), withError(0.02), adaptive, &ofAdaptive);
  RenderOptions evenly = options(6);
  evenly.isAdaptive = false;
  render(evenly, withError(0.02), even, &ofEven);
  // The mean of the deviations, squared, by the mean of their squares.
  const double deviations[] = {0, 1, std::sqrt(7.0), std::sqrt(63.0)};
  double sum = 0, squares = 0;
  for (const double deviation : deviations) {
    sum += deviation / 4;
    squares += deviation * deviation / 4;
  }
  EXPECT_LT(double(ofAdaptive.samples) / double(ofEven.samples), 1.5 * sum * sum / squares);
  EXPECT_NEAR(even.state.error, adaptive.state.error, 0.002);
}

TEST(Adaptive, InterruptionsDoNotShow) {
  PartialRendering whole, parts;
  const Image expected = render(options(9), withError(0.1), whole);
  Image image;
  unsigned interruptions = 0;
  for (const std::uint32_t most : {3u, 16u, 17u, 40u, 90u, 1u << 20}) {
    std::atomic<bool> cancel{false};
    RenderOptions some = options(9, most);
    some.cancel = &cancel;
    PassOptions passes = withError(0.1);
    passes.secondsBetweenCheckpoints = 0;
    passes.checkpoint = [&](const PartialRendering &rendering, bool isLast) {
      cancel = cancel || (!isLast && interruptions++ % 3 == 2);
      EXPECT_EQ(rendering.sums.pixels(), std::size_t(width * height));
    };
    render(some, passes, parts);
  }
  image = render(options(9), withError(0.1), parts);
  EXPECT_EQ(image.pixels, expected.pixels);
  EXPECT_EQ(parts.sums.taken, whole.sums.taken);
  EXPECT_EQ(parts.sums.closed, whole.sums.closed);
  EXPECT_EQ(parts.state.error, whole.state.error);
}

TEST(Adaptive, WhatOneHalfHasSeenDecidesAboutTheOther) {
  PixelSums sums = PixelSums::make(2, 1, true);
  sums.taken = {32, 32};
  sums.counted = sums.deciding = {16, 16, 16, 16};
  sums.values = {16, 16, 16, 16};
  sums.squares = {16, 1000, 16, 1000}; // the second half of both pixels varies
  sums.colors = sums.values;
  const double error = closeHalves(sums, 2, 0.1);
  EXPECT_EQ(sums.closed, (std::vector<std::uint32_t>{2, 2})); // the second half is complete
  const double variance = (1000.0 / 16 - 1) * 16 / 15;        // of samples, of which 32 have a mean
  EXPECT_NEAR(error, std::sqrt((variance / 32 + 0) / 2), 1e-12);
}

TEST(Adaptive, PicturesWithoutVarianceAreComplete) {
  for (const double value : {0.0, 1.0}) {
    PixelSums sums = PixelSums::make(1, 1, true);
    sums.taken = {16};
    sums.counted = sums.deciding = {8, 8};
    sums.values = sums.squares = sums.colors = {8 * value, 8 * value};
    EXPECT_EQ(closeHalves(sums, 1, 0.1), 0);
    EXPECT_EQ(sums.closed.front(), PixelSums::allClosed);
  }
}

TEST(Adaptive, SumsOfOneKindDoNotGoOnAsTheOther) {
  PartialRendering rendering;
  render(options(1, 4), withError(0.1), rendering);
  RenderOptions evenly = options(1, 8);
  evenly.isAdaptive = false;
  EXPECT_THROW(render(evenly, withError(0.1), rendering), rtsl::Error);
}
