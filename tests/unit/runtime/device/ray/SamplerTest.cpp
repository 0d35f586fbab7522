// The evenly spread numbers of runtime/device/ray/Sampler.h.
#include "runtime/device/ray/Sampler.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

using namespace rtsl::device;

namespace {

constexpr std::uint32_t r2 = RTSL_FEATURE_SAMPLER_R2, sobol = RTSL_FEATURE_SAMPLER_SOBOL;

std::pair<double, double> point(std::uint32_t sampler, std::uint32_t sample, std::uint32_t place,
                                std::uint32_t pair) {
  return {evenFraction(sampler, sample, place, pair, 0) * 0x1p-32,
          evenFraction(sampler, sample, place, pair, 1) * 0x1p-32};
}

/// The mean square error of an integral over the unit square, of a function that jumps, with
/// `count` samples.
template <typename Point>
double errorOfIntegral(std::uint32_t count, Point at) {
  constexpr unsigned repeats = 400;
  const double truth = 3.14159265358979 / 4;
  double squares = 0;
  for (std::uint32_t place = 0; place < repeats; ++place) {
    double sum = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
      const auto [x, y] = at(i, place);
      sum += x * x + y * y < 1;
    }
    squares += std::pow(sum / count - truth, 2);
  }
  return squares / repeats;
}

} // namespace

TEST(Sampler, SobolHasOnePointInEachBoxOfEqualSize) {
  constexpr unsigned bits = 8;
  for (std::uint32_t place : {1u, 0xdeadbeefu})
    for (std::uint32_t pair : {0u, 1u, 1000u})
      for (unsigned across = 0; across <= bits; ++across) {
        std::set<std::pair<int, int>> boxes;
        for (std::uint32_t i = 0; i < 1u << bits; ++i) {
          const auto [x, y] = point(sobol, i, place, pair);
          boxes.insert({int(std::ldexp(x, int(across))), int(std::ldexp(y, int(bits - across)))});
        }
        EXPECT_EQ(boxes.size(), 1u << bits) << across;
      }
}

TEST(Sampler, PointsAreSpreadMoreEvenlyThanRandomOnes) {
  constexpr std::uint32_t count = 256;
  const double random = errorOfIntegral(count, [](std::uint32_t i, std::uint32_t place) {
    const Words4 words = hash4(i, place, 3, 4);
    return std::pair(words.x * 0x1p-32, words.y * 0x1p-32);
  });
  EXPECT_NEAR(random, 0.785 * 0.215 / count, 0.785 * 0.215 / count / 3);
  for (std::uint32_t sampler : {r2, sobol}) {
    const double even = errorOfIntegral(
        count, [&](std::uint32_t i, std::uint32_t place) { return point(sampler, i, place, 0); });
    EXPECT_LT(even, random / 8) << sampler;
  }
}

TEST(Sampler, ANumberOfAnySampleIsUniform) {
  for (std::uint32_t sampler : {r2, sobol})
    for (std::uint32_t sample : {0u, 1u, 77u, 1000000u}) {
      constexpr std::uint32_t places = 20000;
      double sum = 0, squares = 0, product = 0;
      for (std::uint32_t place = 0; place < places; ++place) {
        const auto [x, y] = point(sampler, sample, hash3(place, 0, 0).x, 2);
        sum += x;
        squares += x * x;
        product += (x - 0.5) * (y - 0.5);
      }
      EXPECT_NEAR(sum / places, 0.5, 5 * std::sqrt(1.0 / 12 / places));
      EXPECT_NEAR(squares / places, 1.0 / 3, 5 * std::sqrt(4.0 / 45 / places));
      EXPECT_NEAR(product / places, 0, 5 * std::sqrt(1.0 / 144 / places));
    }
}

TEST(Sampler, PairsAndPlacesHaveNothingToDoWithEachOther) {
  // Among all samples of a pixel: the same sequence in another order is independent of it.
  for (std::uint32_t sampler : {r2, sobol}) {
    constexpr std::uint32_t count = 4096;
    const auto correlation = [&](auto first, auto second) {
      double product = 0;
      for (std::uint32_t i = 0; i < count; ++i)
        product += (first(i) - 0.5) * (second(i) - 0.5);
      return 12 * product / count;
    };
    const double limit = 5 / std::sqrt(double(count));
    for (std::uint32_t other = 1; other < 20; ++other) {
      EXPECT_NEAR(correlation([&](std::uint32_t i) { return point(sampler, i, 9, 0).first; },
                              [&](std::uint32_t i) { return point(sampler, i, 9, other).first; }),
                  0, limit);
      EXPECT_NEAR(
          correlation([&](std::uint32_t i) { return point(sampler, i, 9, 0).first; },
                      [&](std::uint32_t i) { return point(sampler, i, 9 + other, 0).first; }),
          0, limit);
    }
  }
}

TEST(Sampler, TheOrderOfPointsIsAPermutation) {
  for (std::uint32_t seed : {0u, 1u, 0x12345678u}) {
    std::set<std::uint32_t> first;
    for (std::uint32_t i = 0; i < 1u << 12; ++i)
      first.insert(reverseBits(permuteUpwards(reverseBits(i), seed)) >> 12);
    EXPECT_EQ(first.size(), 1u); // 2^12 successive points
  }
}

TEST(Sampler, TimesOfIndependentSamplesAreSpreadOverTheShutter) {
  int inParts[16] = {};
  for (std::uint32_t i = 0; i < 64; ++i) {
    const float time = unitFloat(reverseBits(i) ^ 0x12345678u);
    ASSERT_GE(time, 0);
    ASSERT_LT(time, 1);
    ++inParts[int(time * 16)];
  }
  for (int count : inParts)
    EXPECT_EQ(count, 4);
}
