// The numbers of the samples in a slice, and the sums of slices.
#include "runtime/device/organisations/Slice.h"
#include "runtime/device/organisations/SampleSums.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>
#include <utility>
#include <vector>

namespace {

namespace device = rtsl::device;

RtslJob window(std::uint32_t width, std::uint32_t height) {
  RtslJob job{};
  device::setWindowSize(job, width, height);
  job.samplesPerPixel = 1;
  device::setSampleCount(job, 1);
  return job;
}

/// A job of one pixel with three components, and what it points to.
struct OnePixel {
  RtslLaunch launch{};
  RtslStatus status{};
  double colors[3] = {}, squares = 0;
  std::uint32_t counted = 0, taken = 0;
  float mean[3] = {-1, -1, -1};
  RtslJob job = window(1, 1);

  OnePixel() {
    launch.colorComponents = 3;
    job.launch = &launch;
    job.status = &status;
    job.pixels = mean;
  }
  void keepSums() { job.sums = {colors, &squares, &counted, &taken, nullptr, nullptr, nullptr}; }
  /// Adds samples that follow those before, of a rendering of `all` samples per pixel.
  void add(std::vector<float> samples, std::uint32_t all) {
    job.samples = samples.data();
    job.samplesPerPixel = all;
    job.firstSample = taken;
    device::setSampleCount(job, static_cast<std::uint32_t>(samples.size() / 3));
    status.nextSample = job.sampleCount;
    device::addSamples(job, 0, 1);
  }
};

} // namespace

TEST(Slice, BandsMayHaveMorePixelsThanAWordCounts) {
  const RtslJob job = window(0x50000000u, 3);
  for (const std::uint32_t place : {0u, 1u, 0x12345678u, 0xefffffffu}) {
    const device::Pixel pixel = device::pixelAt(job, place);
    EXPECT_EQ(pixel.x, place / 3);
    EXPECT_EQ(pixel.y, place % 3);
  }
}

TEST(Slice, NumbersEachPixelOnce) {
  for (const auto &[width, height] : std::vector<std::pair<std::uint32_t, std::uint32_t>>{
           {1, 1}, {7, 1}, {1, 7}, {5, 3}, {8, 4}, {13, 6}, {33, 9}, {64, 64}}) {
    const RtslJob job = window(width, height);
    std::set<std::uint64_t> numbers;
    for (std::uint32_t place = 0; place < width * height; ++place) {
      const device::Pixel pixel = device::pixelAt(job, place);
      EXPECT_LT(pixel.x, width);
      EXPECT_LT(pixel.y, height);
      numbers.insert(pixel.number(job));
    }
    EXPECT_EQ(numbers.size(), std::size_t(width) * height) << width << " x " << height;
  }
}

TEST(Slice, PixelsOfAWarpAreInATile) {
  const RtslJob job = window(64, 12);
  for (std::uint32_t first = 0; first < 64 * 12; first += 32) {
    const device::Pixel corner = device::pixelAt(job, first);
    for (std::uint32_t i = 0; i < 32; ++i) {
      const device::Pixel pixel = device::pixelAt(job, first + i);
      EXPECT_EQ(pixel.x / 8, corner.x / 8);
      EXPECT_EQ(pixel.y / 4, corner.y / 4);
    }
  }
}

TEST(SampleSums, SlicesHaveTheBitsOfTheirWhole) {
  const std::vector<float> samples = {1e8f, 0.1f, 3, -1e8f, 0.7f, 1e-30f, 5, 1e30f, -0.0f, 2, 2, 2};
  OnePixel whole, parts;
  whole.add(samples, 4);
  parts.keepSums();
  parts.add({samples.begin(), samples.begin() + 3}, 4);
  parts.add({samples.begin() + 3, samples.begin() + 9}, 4);
  parts.add({samples.begin() + 9, samples.end()}, 4);
  EXPECT_TRUE(std::equal(whole.mean, whole.mean + 3, parts.mean));
  EXPECT_EQ(parts.mean[0], float((1e8 - 1e8 + 5.0 + 2.0) / 4));
  EXPECT_EQ(parts.counted, 4u);
}

TEST(SampleSums, LeaveOutWhatIsNotFinite) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN(),
                  infinity = std::numeric_limits<float>::infinity();
  OnePixel pixel;
  pixel.keepSums();
  pixel.add({1, 2, nan, 3, 3, 3}, 4);
  pixel.add({5, 5, 5, infinity, 0, 0}, 4);
  EXPECT_EQ(pixel.mean[0], 4);
  EXPECT_EQ(pixel.squares, 9.0 + 25.0);
  EXPECT_EQ(pixel.counted, 2u);
  EXPECT_EQ(pixel.taken, 4u);
  EXPECT_EQ(pixel.status.samplesNotFinite, 2u);
  EXPECT_EQ(~pixel.status.firstNotFinite[0], 0u); // of pixel 0
  EXPECT_EQ(~pixel.status.firstNotFinite[1], 3u);
  EXPECT_EQ(pixel.status.pixelsWithoutSample, 0u);

  OnePixel none;
  none.add({nan, 0, 0}, 1);
  EXPECT_EQ(none.mean[0], 0);
  EXPECT_EQ(none.status.pixelsWithoutSample, 1u);
}

TEST(SampleSums, AddOnlyWhatWasTaken) {
  RtslLaunch launch{};
  launch.colorComponents = 1;
  RtslStatus status{};
  RtslJob job = window(5, 1);
  std::vector<float> samples(10, 1), means(5);
  job.launch = &launch;
  job.status = &status;
  job.samples = samples.data();
  job.pixels = means.data();
  job.samplesPerPixel = 2;
  device::setSampleCount(job, 2);
  samples[4] = 3;
  status.nextSample = 5; // the first sample of the third pixel is the last
  device::addSamples(job, 0, 2);
  device::addSamples(job, 1, 2);
  EXPECT_EQ(means, (std::vector<float>{1, 1, 3, 0, 0}));
}
