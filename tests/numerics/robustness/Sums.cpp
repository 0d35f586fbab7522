//===- Sums.cpp - pixels of many samples ----------------------------------===//
#include "Generators.h"
#include "Row.h"
#include "Timing.h"
#include "Worst.h"

#include "runtime/device/organisations/SampleSums.h"

#include <cmath>
#include <vector>

namespace rtsl::numerics {

namespace {

/// Adds samples to a pixel as the renderer does, in slices, and gives its value.
class Pixel {
public:
  explicit Pixel(std::uint32_t samples) {
    launch.colorComponents = 1;
    device::setLaunchSize(launch, 1, 1, 1);
    job.launch = &launch;
    job.status = &status;
    device::setWindowSize(job, 1, 1);
    job.samplesPerPixel = samples;
    job.pixels = &value;
    job.sums = {&sum, &squares, &counted, &taken, nullptr, nullptr, nullptr};
  }
  void add(float sample) {
    slice.push_back(sample);
    if (slice.size() == samplesOfSlice)
      addSlice();
  }
  float finish() {
    if (!slice.empty())
      addSlice();
    return value;
  }

private:
  static constexpr std::size_t samplesOfSlice = 4096;

  void addSlice() {
    job.samples = slice.data();
    job.firstSample = taken;
    device::setSampleCount(job, std::uint32_t(slice.size()));
    status.nextSample = slice.size();
    device::addSamples(job, 0, 1);
    slice.clear();
  }

  RtslLaunch launch{};
  RtslStatus status{};
  RtslJob job{};
  double sum = 0, squares = 0;
  std::uint32_t counted = 0, taken = 0;
  std::vector<float> slice;
  float value = 0;
};

/// A million samples a pixel, each 1e-4 or 1e8, in random order and in the worst ones, against the
/// exact mean: both kinds are added up as integers.
Outcome runBrightAndDark(std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  constexpr std::uint32_t samples = 1'000'000;
  for (std::uint64_t i = 0; i < cases / samples; ++i) {
    const std::uint64_t oneIn = std::uint64_t(1) << random.integer(1, 19);
    Pixel pixel(samples);
    std::uint64_t bright = 0;
    for (std::uint32_t sample = 0; sample < samples; ++sample) {
      const bool isBright = i % 3 == 0   ? random.index(oneIn) == 0
                            : i % 3 == 1 ? sample < samples / oneIn // all the bright ones first
                                         : sample >= samples - samples / oneIn; // or last
      bright += isBright;
      pixel.add(isBright ? 1e8f : 1e-4f);
    }
    const long double truth =
        ((long double)bright * 1e8f + (long double)(samples - bright) * 1e-4f) / samples;
    worst.add(double(std::fabs(((long double)pixel.finish() - truth) / truth)),
              [&] { return "one bright sample in " + std::to_string(oneIn); });
  }
  return worst.outcome();
}

double nanosecondsASample() {
  constexpr int count = 1'000'000;
  return timeOf(count, [&] {
    Pixel pixel(count);
    for (int i = 0; i < count; ++i)
      pixel.add(float(i));
    return pixel.finish();
  });
}

} // namespace

std::vector<Row> sumRows() {
  return {{"sums.brightAndDark",
           "pixels of a million samples of 1e-4 and 1e8: the mean against exact arithmetic",
           "relative error", 200'000'000, runBrightAndDark, nanosecondsASample}};
}

} // namespace rtsl::numerics
