#include "runtime/device/Random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

using namespace rtsl::device;

namespace {

/// Chi-squared over equal bins, as a multiple of its standard deviation from its mean.
double chiSquaredDeviations(const std::vector<double> &values, unsigned bins) {
  std::vector<double> counts(bins, 0.0);
  for (double value : values)
    ++counts[std::min(unsigned(value * bins), bins - 1)];
  double expected = double(values.size()) / bins, sum = 0;
  for (double count : counts)
    sum += (count - expected) * (count - expected) / expected;
  return (sum - (bins - 1)) / std::sqrt(2.0 * (bins - 1));
}

} // namespace

TEST(Random, UniformOverDimensionsPixelsAndSamples) {
  std::vector<double> alongDimensions, alongPixels, alongSamples, alongChildren;
  for (std::uint32_t i = 0; i < 200000; ++i) {
    Words4 fixed = hash4(17, 4, 0, 1), pixel = hash4(i % 1000, i / 1000, 0, 1),
           sample = hash4(17, 4, i, 1);
    std::uint32_t a[2] = {fixed.x, fixed.y}, b[2] = {pixel.x, pixel.y}, c[2] = {sample.x, sample.y},
                  child[2];
    alongDimensions.push_back(double(randomNumber(a, i)));
    alongPixels.push_back(double(randomNumber(b, 0)));
    alongSamples.push_back(double(randomNumber(c, 3)));
    childKey(a, i, child);
    alongChildren.push_back(double(randomNumber(child, 0)));
  }
  for (const std::vector<double> *values :
       {&alongDimensions, &alongPixels, &alongSamples, &alongChildren})
    for (unsigned bins : {10u, 256u, 1000u})
      EXPECT_LT(std::fabs(chiSquaredDeviations(*values, bins)), 5);
}

TEST(Random, NeighboursAreUncorrelated) {
  auto correlation = [](auto next) {
    double sum = 0;
    constexpr int n = 100000;
    for (std::uint32_t i = 0; i < n; ++i) {
      auto [a, b] = next(i);
      sum += (double(a) - 0.5) * (double(b) - 0.5);
    }
    return sum / n * 12 * std::sqrt(double(n)); // in standard deviations
  };
  std::uint32_t key[2] = {123, 456};
  EXPECT_LT(std::fabs(correlation([&](std::uint32_t i) {
              return std::pair(randomNumber(key, i), randomNumber(key, i + 1));
            })),
            5);
  EXPECT_LT(std::fabs(correlation([&](std::uint32_t i) {
              Words4 a = hash4(i, 0, 0, 0), b = hash4(i + 1, 0, 0, 0);
              std::uint32_t ka[2] = {a.x, a.y}, kb[2] = {b.x, b.y};
              return std::pair(randomNumber(ka, 0), randomNumber(kb, 0));
            })),
            5);
  // What a ray draws, and what the ray that it spawns at the same count draws.
  EXPECT_LT(std::fabs(correlation([&](std::uint32_t i) {
              std::uint32_t child[2];
              childKey(key, i, child);
              return std::pair(randomNumber(key, i), randomNumber(child, i));
            })),
            5);
}

TEST(Random, NeverReachesOne) {
  EXPECT_EQ(unitFloat(0xffffffffu), 1 - 0x1p-24f);
  EXPECT_EQ(unitFloat(0), 0);
}

TEST(Random, SamplesOfAPixelAreStratified) {
  // The points of a pixel fill it more evenly than random ones: no cell of a coarse grid stays
  // empty.
  for (std::uint32_t shift : {0u, 0x12345678u, 0xdeadbeefu}) {
    bool filled[4][4] = {};
    for (std::uint32_t i = 0; i < 32; ++i) {
      float x, y;
      pixelSample(i, shift, ~shift, &x, &y);
      ASSERT_TRUE(x >= 0 && x < 1 && y >= 0 && y < 1);
      filled[int(x * 4)][int(y * 4)] = true;
    }
    for (auto &row : filled)
      for (bool cell : row)
        EXPECT_TRUE(cell);
  }
}
