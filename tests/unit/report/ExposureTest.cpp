#include "report/measures/Exposure.h"

#include <gtest/gtest.h>

#include <limits>

using namespace rtsl;
using namespace rtsl::report;

namespace {

/// 100 pixels with these shares of a brightness; the rest is half as bright as the first.
runtime::Image picture(float value, unsigned brighter = 0, float highlight = 0) {
  runtime::Image image(10, 10, 3);
  for (std::size_t i = 0; i < 100; ++i)
    for (std::size_t channel = 0; channel < 3; ++channel)
      image.pixels[3 * i + channel] = i < brighter ? highlight : value;
  return image;
}

} // namespace

TEST(Exposure, LeavesPicturesThatAScreenShows) {
  EXPECT_EQ(stopsFor(picture(0.5f)), 0);
  EXPECT_EQ(stopsFor(picture(1)), 0);
  EXPECT_EQ(stopsFor(picture(0.5f, 1, 1000)), 0) << "a highlight may be white";
  EXPECT_EQ(stopsFor(picture(0)), 0) << "black stays black";
}

TEST(Exposure, BringsBrightAndDarkPicturesToTheScreen) {
  for (float value : {1e-6f, 0.01f, 3.0f, 70.0f, 1e5f}) {
    const runtime::Image shown = exposed(picture(value), stopsFor(picture(value)));
    EXPECT_GT(shown.pixels[0], 0.9 * 0.8) << value;
    EXPECT_LE(shown.pixels[0], 0.9 * 1.2) << value;
  }
  EXPECT_LT(stopsFor(picture(100, 1, 1e6f)), -6);
  EXPECT_GT(stopsFor(picture(0, 1, 0.001f)), 0) << "a picture that is black but for a pixel";
}

TEST(Exposure, CountsWhatIsBeyondTheScreen) {
  EXPECT_DOUBLE_EQ(shareBeyondScreen(picture(0.5f, 30, 2)), 0.3);
  EXPECT_EQ(stopsFor(picture(std::numeric_limits<float>::quiet_NaN())), 0);
}
