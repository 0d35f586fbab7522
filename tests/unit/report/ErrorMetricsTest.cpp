#include "report/measures/ErrorMetrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace rtsl;
using report::ErrorMetrics;
using runtime::Image;

namespace {

Image pixels(std::vector<float> values) {
  Image image(std::uint32_t(values.size() / 3), 1, 3);
  image.pixels = std::move(values);
  return image;
}

} // namespace

TEST(ErrorMetrics, MatchTheirDefinitions) {
  const ErrorMetrics metrics =
      report::measureError(pixels({1, 2, 3, 0, 0, 0}), pixels({1, 2, 4, 0, 0.5, 0}));
  EXPECT_DOUBLE_EQ(metrics.rmse, std::sqrt((1 + 0.25) / 6));
  EXPECT_DOUBLE_EQ(metrics.relMse, (1 / 9.01 + 0.25 / 0.01) / 6);
  EXPECT_DOUBLE_EQ(metrics.bias, 1.5 / 6);
  EXPECT_DOUBLE_EQ(metrics.largest, 1);
  EXPECT_EQ(metrics.pixelsThatDiffer, 2u);
}

TEST(ErrorMetrics, CountWhatIsNotFiniteApart) {
  const float nan = std::numeric_limits<float>::quiet_NaN(),
              infinity = std::numeric_limits<float>::infinity();
  const ErrorMetrics metrics = report::measureError(
      pixels({1, 1, 1, 1, 1, 1, 1, 1, 1}), pixels({nan, infinity, 1, infinity, 1, 1, 1, 1, 2}));
  EXPECT_EQ(metrics.nanPixels, 1u);
  EXPECT_EQ(metrics.infinitePixels, 1u);
  EXPECT_EQ(metrics.pixels, 1u);
  EXPECT_DOUBLE_EQ(metrics.rmse, std::sqrt(1.0 / 3));
}

TEST(ErrorMetrics, StayExactForHugeAndTinyValues) {
  const ErrorMetrics metrics =
      report::measureError(pixels({1e30f, 1e-30f, 0}), pixels({2e30f, 2e-30f, 0}));
  EXPECT_NEAR(metrics.rmse / (1e30 / std::sqrt(3.0)), 1, 1e-6);
}

TEST(ErrorMetrics, ReportThatNothingCouldBeCompared) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const ErrorMetrics metrics = report::measureError(pixels({nan, 1, 1}), pixels({1, 1, 1}));
  EXPECT_EQ(metrics.pixels, 0u);
  EXPECT_EQ(metrics.incomparable, 1u);
  EXPECT_EQ(report::measureError(pixels({nan, 1, 1}), pixels({nan, 1, 1})).incomparable, 0u);
}

TEST(ErrorMetrics, RefuseTwoShapes) {
  EXPECT_THROW(report::measureError(pixels({1, 1, 1}), pixels({1, 1, 1, 2, 2, 2})), Error);
}

TEST(ErrorMetrics, MapsHaveTheMeanOfTheMetric) {
  const Image reference = pixels({1, 2, 3, 0, 0, 0}), test = pixels({1, 2, 4, 0, 0.5, 0});
  const Image map = report::relativeSquaredErrorMap(reference, test);
  EXPECT_NEAR((map.pixels[0] + map.pixels[1]) / 2, report::measureError(reference, test).relMse,
              1e-6);
}
