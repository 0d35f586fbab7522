// FLIP against the figures of its authors' program on two pairs of pictures, and its properties.
#include "report/measures/Flip.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace rtsl;
using report::FlipExposures;
using report::FlipMap;
using runtime::Image;

namespace {

Image readData(const std::string &name) {
  return runtime::readImage(std::string(RTSL_ROOT) + "/tests/unit/report/data/" + name);
}

Image flat(float red, float green, float blue, std::uint32_t size = 32) {
  Image image(size, size, 3);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    image.pixels[i] = i % 3 == 0 ? red : i % 3 == 1 ? green : blue;
  return image;
}

float largest(const FlipMap &map) {
  return *std::max_element(map.error.begin(), map.error.end());
}
float smallest(const FlipMap &map) {
  return *std::min_element(map.error.begin(), map.error.end());
}

} // namespace

TEST(Flip, AgreesWithItsAuthorsOnLowDynamicRange) {
  const FlipMap map = report::flip(readData("reference.png"), readData("test.png"), 67);
  EXPECT_NEAR(map.mean(), 0.082488, 1e-4);
  EXPECT_NEAR(smallest(map), 0.0, 1e-4);
  EXPECT_NEAR(largest(map), 0.652965, 1e-3);
}

TEST(Flip, AgreesWithItsAuthorsOnHighDynamicRange) {
  const Image reference = readData("reference.exr");
  const FlipExposures exposures = report::exposuresFor(reference);
  EXPECT_NEAR(exposures.first, -3.8821, 1e-3);
  EXPECT_NEAR(exposures.last, 3.9537, 1e-3);
  EXPECT_EQ(exposures.count, 8u);
  const FlipMap map = report::flipHdr(reference, readData("test.exr"), exposures, 67);
  EXPECT_NEAR(map.mean(), 0.177722, 1e-4);
  EXPECT_NEAR(smallest(map), 0.049702, 1e-3);
  EXPECT_NEAR(largest(map), 0.531510, 1e-3);
}

TEST(Flip, IsZeroForTheSamePicture) {
  const Image picture = readData("test.png");
  EXPECT_EQ(report::flip(picture, picture).mean(), 0);
}

TEST(Flip, IsLargestBetweenGreenAndBlue) {
  EXPECT_NEAR(report::flip(flat(0, 1, 0), flat(0, 0, 1)).mean(), 1.0, 1e-6);
  EXPECT_NEAR(report::flip(flat(0, 0, 0), flat(1, 1, 1)).mean(), 0.967, 1e-3);
}

TEST(Flip, IsSymmetric) {
  const Image a = readData("reference.png"), b = readData("test.png");
  EXPECT_NEAR(report::flip(a, b).mean(), report::flip(b, a).mean(), 1e-6);
}

TEST(Flip, CountsWhatIsNotANumberAsBlack) {
  const float nan = std::numeric_limits<float>::quiet_NaN(),
              infinity = std::numeric_limits<float>::infinity();
  EXPECT_EQ(report::flip(flat(0, 0, 0), flat(nan, -1, -infinity)).mean(), 0);
  EXPECT_EQ(report::flip(flat(1, 1, 1), flat(infinity, 2, 1)).mean(), 0);
  const FlipMap map = report::flipHdr(flat(1, 1, 1), flat(infinity, nan, -1), {-2, 2, 3});
  EXPECT_TRUE(map.mean() > 0 && map.mean() <= 1) << map.mean();
}

TEST(Flip, FindsExposuresForBlackPictures) {
  const FlipExposures exposures = report::exposuresFor(flat(0, 0, 0));
  EXPECT_TRUE(std::isfinite(exposures.first) && std::isfinite(exposures.last));
  EXPECT_EQ(exposures.count, 2u);
}

TEST(Flip, RefusesPicturesOfTwoSizes) {
  EXPECT_THROW(report::flip(flat(0, 0, 0, 4), flat(0, 0, 0, 5)), Error);
  EXPECT_THROW(report::flip(Image(4, 4, 1), Image(4, 4, 1)), Error);
}
