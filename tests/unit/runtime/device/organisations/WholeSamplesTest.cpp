// Lanes of programs without states, which render samples or whole pixels.
#include "runtime/device/organisations/WholeSamples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace {

namespace device = rtsl::device;

constexpr std::uint32_t width = 13, height = 7, ofPixel = 5;

/// A job for the pictures of the fake program, and what it points to.
struct Picture {
  RtslLaunch launch{};
  RtslStatus status{};
  std::vector<double> colors = std::vector<double>(3 * width * height);
  std::vector<std::uint32_t> counted = std::vector<std::uint32_t>(width * height), taken = counted;
  std::vector<float> means = std::vector<float>(3 * width * height, -1.0f);
  std::vector<float> samples = std::vector<float>(3 * width * height * ofPixel, -1.0f);
  RtslJob job{};

  Picture() {
    device::setLaunchSize(launch, width, height, 1);
    launch.colorComponents = 3;
    launch.needs = RTSL_NEEDS_LAUNCH;
    launch.status = &status;
    job.launch = &launch;
    job.status = &status;
    job.samplesPerPixel = ofPixel;
    device::setWindowSize(job, width, height);
    device::setSampleCount(job, ofPixel);
    job.samples = samples.data();
    job.pixels = means.data();
  }
  void keepSums() {
    job.sums = {colors.data(), nullptr, counted.data(), taken.data(), nullptr, nullptr, nullptr};
  }
  /// The samples `first` to `end` - 1 of each pixel.
  void setSlice(std::uint32_t first, std::uint32_t end) {
    job.firstSample = first;
    device::setSampleCount(job, end - first);
    status.nextSample = 0;
    status.hasSums = 0;
  }
};

/// The launches of a slice with `count` threads for this number of samples each. Threads run in any
/// order, and the last block has some that have nothing to do.
void launchThreads(Picture &picture, std::uint32_t count, std::uint32_t ofThread,
                   void (*run)(const RtslJob &, std::uint32_t)) {
  RtslJob &job = picture.job;
  const std::uint32_t all = device::samplesOfSlice(job);
  for (job.firstOfLaunch = 0; job.firstOfLaunch < all; job.firstOfLaunch = job.endOfLaunch) {
    job.endOfLaunch = std::min(job.firstOfLaunch + count * ofThread, all);
    for (std::uint32_t thread = count + 3; thread-- > 0;)
      run(job, thread);
    EXPECT_EQ(picture.status.nextSample, job.endOfLaunch);
  }
}
void launchPixels(Picture &picture, std::uint32_t count = 20) {
  launchThreads(picture, count, picture.job.sampleCount, device::renderPixelOfThread);
}
void launchSamples(Picture &picture, std::uint32_t count = 70) {
  launchThreads(picture, count, 1, device::renderSampleOfThread);
}

/// By the definition: each sample alone, added in the order of their numbers.
std::vector<float> expected() {
  Picture picture;
  std::vector<float> means;
  for (std::uint32_t y = 0; y < height; ++y)
    for (std::uint32_t x = 0; x < width; ++x) {
      double sum[3] = {};
      for (std::uint32_t number = 0; number < ofPixel; ++number) {
        float color[RTSL_MAX_COLOR];
        device::generate(picture.launch, x, y, number, color);
        for (int i = 0; i < 3; ++i)
          sum[i] += double(color[i]);
      }
      for (const double one : sum)
        means.push_back(float(one / ofPixel));
    }
  return means;
}

} // namespace

TEST(WholeSamples, SamplesAreStored) {
  Picture picture;
  device::runWholeSamples(picture.job);
  EXPECT_FALSE(picture.status.hasSums);
  device::addSamples(picture.job, 0, 1);
  EXPECT_EQ(picture.means, expected());
  EXPECT_NE(picture.means[0], picture.means[3]); // the fake program shows something
}

TEST(WholeSamples, ThreadsOfSamplesStoreThem) {
  for (const std::uint32_t count : {1u, 64u, 10000u}) {
    Picture picture;
    launchSamples(picture, count);
    EXPECT_FALSE(picture.status.hasSums);
    device::addSamples(picture.job, 0, 1);
    EXPECT_EQ(picture.means, expected());
  }
}

TEST(WholeSamples, ThreadsOfPixelsAddThem) {
  for (const std::uint32_t count : {1u, 20u, 10000u}) {
    Picture picture;
    launchPixels(picture, count);
    EXPECT_TRUE(picture.status.hasSums);
    EXPECT_EQ(picture.means, expected());
    EXPECT_EQ(picture.samples[0], -1.0f); // nothing is stored
  }
}

TEST(WholeSamples, SlicesGoOn) {
  Picture picture;
  picture.keepSums();
  picture.setSlice(0, 2);
  launchPixels(picture);
  picture.setSlice(2, 3);
  launchSamples(picture);
  device::addSamples(picture.job, 0, 1);
  picture.setSlice(3, 4);
  device::runWholeSamples(picture.job);
  device::addSamples(picture.job, 0, 1);
  picture.setSlice(4, ofPixel);
  launchPixels(picture);
  EXPECT_EQ(picture.means, expected());
  EXPECT_EQ(picture.taken, std::vector<std::uint32_t>(width * height, ofPixel));
}

TEST(WholeSamples, PixelsThatHaveASampleAreLeftOut) {
  for (const bool haveThreads : {false, true}) {
    Picture picture;
    picture.keepSums();
    const std::vector<std::uint32_t> places = {5, 40, 90};
    picture.setSlice(0, 2);
    picture.job.places = places.data();
    picture.job.placeCount = 3;
    launchPixels(picture, 2);
    picture.job.places = nullptr;
    picture.setSlice(0, ofPixel);
    picture.job.taken = picture.taken.data();
    if (haveThreads)
      launchSamples(picture);
    else
      device::runWholeSamples(picture.job);
    device::addSamples(picture.job, 0, 1);
    EXPECT_EQ(picture.means, expected());
  }
}

TEST(WholeSamples, NothingIsTakenAfterAStop) {
  Picture picture;
  picture.status.stop = 1;
  device::runWholeSamples(picture.job);
  EXPECT_EQ(picture.status.nextSample, 0u);
  EXPECT_EQ(picture.means[0], -1.0f);
}
