#include "runtime/device/ray/Random.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
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
  const std::uint32_t ones[5] = {~0u, ~0u, ~0u, ~0u, ~0u}, zeros[5] = {};
  EXPECT_EQ(floatOfFraction(ones), 1 - 0x1p-24f);
  EXPECT_EQ(floatOfFraction(zeros), 0);
}

namespace {

using Fraction = std::array<std::uint32_t, 5>;

bool bitAt(const Fraction &fraction, int index) {
  return fraction[std::size_t(index / 32)] >> (31 - index % 32) & 1;
}

/// The float below a fraction, bit by bit: 24 of them from the first that is set, none after the
/// 149th.
float floatBelow(const Fraction &fraction) {
  double value = 0;
  int first = -1;
  for (int i = 0; i < 149 && (first < 0 || i < first + 24); ++i)
    if (bitAt(fraction, i)) {
      first = first < 0 ? i : first;
      value += std::ldexp(1.0, -i - 1);
    }
  return float(value);
}

/// The bits of a float below 1 as a fraction.
Fraction fractionOf(float value) {
  Fraction fraction = {};
  double rest = double(value);
  for (int i = 0; i < 149; ++i)
    if (const double bit = std::ldexp(1.0, -i - 1); rest >= bit) {
      fraction[std::size_t(i / 32)] |= 0x80000000u >> (i % 32);
      rest -= bit;
    }
  return fraction;
}

} // namespace

// Each float is what becomes of the numbers from it up to the next one, so that it has the
// probability of that interval.
TEST(Random, EveryFloatHasItsProbability) {
  for (int zeros = 0; zeros < 160; ++zeros)
    for (std::uint32_t i = 0; i < 2000; ++i) {
      const Words4 a = hash4(std::uint32_t(zeros), i, 1, 2), b = hash4(a.x, a.y, 3, 4);
      Fraction fraction = {b.x, b.y, b.z, b.w, a.z};
      for (int bit = 0; bit < zeros; ++bit)
        fraction[std::size_t(bit / 32)] &= ~(0x80000000u >> (bit % 32));
      ASSERT_EQ(floatOfFraction(fraction.data()), floatBelow(fraction)) << zeros << " " << i;
    }
  for (int exponent = -149; exponent < 0; ++exponent)
    for (std::uint32_t i = 0; i < 100; ++i) {
      const float value = std::ldexp(1.0f + float(hash4(i, 5, 6, 7).x >> 9) * 0x1p-23f, exponent);
      if (!(value < 1))
        continue;
      const float next = std::nextafter(value, 2.0f);
      ASSERT_EQ(floatOfFraction(fractionOf(value).data()), value);
      Fraction last = fractionOf(next); // less the smallest bit
      for (std::size_t word = 5; word-- != 0;)
        if (last[word]-- != 0)
          break;
      if (next < 1) {
        ASSERT_EQ(floatOfFraction(last.data()), value);
      }
    }
}

TEST(Random, IsAsUniformNearZeroAsElsewhere) {
  // How many draws lie between 2^-k-1 and 2^-k, and the last digits of those that are small.
  constexpr std::uint32_t draws = 1u << 24;
  constexpr int octaves = 14;
  std::vector<double> counts(octaves + 1, 0.0), lastDigits;
  const std::uint32_t key[2] = {0x12345u, 0x6789au};
  for (std::uint32_t i = 0; i < draws; ++i) {
    const float drawn = randomNumber(key, i);
    int exponent;
    const double significand = double(std::frexp(drawn, &exponent)) * 0x1p24;
    ++counts[std::size_t(std::min(-exponent, octaves))];
    if (drawn < 0x1p-9f)
      lastDigits.push_back(std::fmod(significand, 256) / 256);
  }
  double sum = 0;
  for (int k = 0; k <= octaves; ++k) {
    const double expected = std::ldexp(double(draws), -std::min(k + 1, octaves));
    sum += (counts[std::size_t(k)] - expected) * (counts[std::size_t(k)] - expected) / expected;
  }
  EXPECT_LT((sum - octaves) / std::sqrt(2.0 * octaves), 5);
  EXPECT_LT(std::fabs(chiSquaredDeviations(lastDigits, 256)), 5);

  // What follows when the first word is 0: uniform again, below 2^-32.
  std::vector<double> tail;
  for (std::uint32_t i = 0; i < 200000; ++i)
    tail.push_back(std::ldexp(double(smallRandomNumber(key[0], key[1], i, 0)), 32));
  EXPECT_LT(std::fabs(chiSquaredDeviations(tail, 1000)), 5);
}

TEST(Random, FreePathsHaveTheirDistribution) {
  // -log(u) is exponential: its moments are factorials, and however long a path is, one of them is
  // longer.
  double first = 0, second = 0;
  constexpr std::uint32_t draws = 1u << 22;
  const std::uint32_t key[2] = {99, 1};
  for (std::uint32_t i = 0; i < draws; ++i) {
    const double path = -std::log(double(openRandomNumber(key, i)));
    first += path;
    second += path * path;
  }
  EXPECT_NEAR(first / draws, 1, 5 / std::sqrt(double(draws)));
  EXPECT_NEAR(second / draws, 2, 5 * std::sqrt(20 / double(draws)));

  // Beyond 22 mean free paths, where 32 bits hold nothing: draws whose first word is 0 alone,
  // exp(-32 ln 2) of all.
  double sum = 0;
  constexpr std::uint32_t rare = 1u << 18;
  for (std::uint32_t i = 0; i < rare; ++i)
    sum += -std::log(double(smallRandomNumber(key[0], key[1], i, 0))) - 32 * std::log(2.0);
  EXPECT_NEAR(sum / rare, 1, 5 / std::sqrt(double(rare)));
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
