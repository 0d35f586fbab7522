//===- Pixels.cpp - pixels of many samples, by the whole renderer ---------===//
#include "CompiledShaders.h"
#include "Row.h"
#include "Timing.h"
#include "Worst.h"

#include <cmath>

namespace rtsl::numerics {

namespace {

constexpr std::uint32_t samples = 1'000'000;

class Picture {
public:
  explicit Picture(Path path)
      : shaders({"tests/numerics/robustness/shaders/BrightAndDark.rtsl"},
                {"BrightAndDark", "Across"}, {}, path) {
    shaders.scene().setCamera(shaders.scene().addObject("Across"));
    shaders.scene().setBackground(shaders.scene().addObject("BrightAndDark"));
    shaders.finish();
  }

  runtime::Image operator()(std::uint32_t width, std::uint32_t samplesPerPixel,
                            std::uint32_t seed) const {
    runtime::RenderOptions options;
    options.width = width;
    options.height = 1;
    options.samplesPerPixel = samplesPerPixel;
    options.seed = seed;
    return shaders.picture(options);
  }

private:
  CompiledShaders shaders;
};

const Picture &picture(Path path) {
  static const Picture only(path);
  return only;
}

/// A million samples a pixel, each 1e-4 or 1e8, chosen by rand(), against the exact mean.
Outcome runBrightAndDark(Path path, std::uint64_t cases, std::uint32_t seed) {
  Worst worst;
  const auto pixels = std::uint32_t(cases / samples);
  const runtime::Image image = picture(path)(pixels, samples, seed);
  for (std::uint32_t x = 0; x < pixels; ++x) {
    const float *pixel = image.at(x, 0);
    const auto bright = std::lround(
        double(pixel[1]) * samples); // a mean of ones, so that its rounding does not matter
    const long double truth =
        ((long double)bright * 1e8f + (long double)(samples - bright) * 1e-4f) / samples;
    const double error = double(std::fabs(((long double)pixel[0] - truth) / truth));
    worst.add(std::isfinite(pixel[0]) ? error : std::numeric_limits<double>::infinity(),
              [&] { return std::to_string(bright) + " bright samples"; });
  }
  return worst.outcome();
}

double nanosecondsASample(Path path) {
  constexpr int count = 1'000'000;
  return timeOf(count, [&] { return picture(path)(1, count, 1).pixels[0]; });
}

} // namespace

std::vector<Row> pixelRows(Path path) {
  return {
      {"pixels.brightAndDark",
       "rendered pixels of a million samples of 1e-4 and 1e8: the mean against exact arithmetic",
       "relative error", 800'000'000,
       [=](std::uint64_t cases, std::uint32_t seed) { return runBrightAndDark(path, cases, seed); },
       [=] { return nanosecondsASample(path); }}};
}

} // namespace rtsl::numerics
