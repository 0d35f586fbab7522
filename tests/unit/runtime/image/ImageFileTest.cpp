#include "tests/unit/support/Files.h"

#include "report/measures/ErrorMetrics.h"
#include "runtime/image/Image.h"
#include "support/AtomicFile.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace report = rtsl::report;
using namespace rtsl;
using namespace rtsl::runtime;
using rtsl::test::errorOf;
using rtsl::test::Files;

namespace {

Image gradient(std::uint32_t width, std::uint32_t height, std::uint32_t channels) {
  Image image(width, height, channels);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    image.pixels[i] = float(i) / float(image.pixels.size());
  return image;
}

} // namespace

using Pictures = Files;

TEST_F(Pictures, ExrKeepsEveryBit) {
  for (std::uint32_t channels : {1u, 3u, 4u, 12u}) {
    Image image = gradient(37, 11, channels);
    image.pixels[5] = 1e30f;
    image.pixels[6] = -0.0f;
    writeImage(path("a.exr"), image);
    Image back = readImage(path("a.exr"));
    EXPECT_EQ(report::measureError(image, back).pixelsThatDiffer, 0u) << channels;
  }
}

TEST_F(Pictures, PngIsSrgb) {
  Image image(4, 1, 3);
  float values[12] = {0, 0.5f, 1, 2, -1, NAN, 0.2f, 0.002f, 0.9f, 1e-9f, INFINITY, 0.04f};
  std::copy_n(values, 12, image.pixels.begin());
  writeImage(path("a.PNG"), image);
  std::string bytes = readFile(path("a.PNG"));
  EXPECT_EQ(bytes.substr(1, 3), "PNG");
  EXPECT_NE(bytes.find("sRGB"), std::string::npos);
  Image back = readImage(path("a.PNG"));
  ASSERT_EQ(back.channels, 3u);
  float expected[12] = {0, 0.5f, 1, 1, 0, 0, 0.2f, 0.002f, 0.9f, 0, 1, 0.04f};
  for (int i = 0; i < 12; ++i) // half a step of 8 bits
    EXPECT_NEAR(encodeSrgb(back.pixels[std::size_t(i)]), encodeSrgb(expected[i]),
                0.5f / 255 + 1e-5f)
        << i;
}

TEST_F(Pictures, GreyAndSpectralColors) {
  Image grey = gradient(8, 8, 1);
  writeImage(path("g.png"), grey);
  EXPECT_EQ(readImage(path("g.png")).channels, 1u);
  Image rgb = toRgb(grey);
  EXPECT_EQ(rgb.at(3, 3)[0], grey.at(3, 3)[0]);
  EXPECT_EQ(rgb.at(3, 3)[2], grey.at(3, 3)[0]);
  Image white(2, 2, 8);
  std::fill(white.pixels.begin(), white.pixels.end(), 1.0f);
  for (float component : toRgb(white).pixels)
    EXPECT_NEAR(component, 1, 1e-6);
}

TEST_F(Pictures, BadFiles) {
  EXPECT_EQ(errorOf([&] { checkWritable(path("a.jpg")); }),
            "unsupportedFormat: cannot determine the format of `" + path("a.jpg") +
                "`: a picture's name ends in `.png` or `.exr`");
  EXPECT_EQ(errorOf([&] { checkWritable(path("png")); }).substr(0, 17), "unsupportedFormat");
  EXPECT_EQ(errorOf([&] { readImage(put("junk.png", "junk")); }).substr(0, 8), "badImage");
  EXPECT_EQ(errorOf([&] { readImage(put("junk.exr", "junk")); }).substr(0, 8), "badImage");
  EXPECT_EQ(errorOf([&] { readImage(path("none.exr")); }).substr(0, 12), "fileNotFound");
  writeImage(path("a.png"), gradient(64, 64, 3));
  writeImage(path("a.exr"), gradient(64, 64, 3));
  for (const char *file : {"a.png", "a.exr"}) {
    std::string bytes = readFile(path(file));
    put(file, bytes.substr(0, bytes.size() / 2));
    EXPECT_EQ(errorOf([&] { readImage(path(file)); }).substr(0, 8), "badImage") << file;
  }
}

TEST(Srgb, RoundTrips) {
  for (int i = 0; i <= 255; ++i)
    EXPECT_EQ(int(encodeSrgb(decodeSrgb(float(i) / 255)) * 255 + 0.5f), i);
}
