#include "report/LineFit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace rtsl::report;

TEST(LineFit, FindsALine) {
  const LineFit fit = fitLine({0, 1, 2, 3}, {5, 4, 3, 2});
  EXPECT_EQ(fit.points, 4u);
  EXPECT_NEAR(fit.slope.value, -1, 1e-12);
  EXPECT_NEAR(fit.intercept, 5, 1e-12);
  EXPECT_NEAR(fit.slope.high - fit.slope.low, 0, 1e-9);
}

// The residuals' squares sum to 0.107, and t of 3 degrees has 3.182446 at 97.5 %.
TEST(LineFit, HasTheIntervalOfStudentsT) {
  const LineFit fit = fitLine({1, 2, 3, 4, 5}, {1.1, 1.9, 3.2, 3.8, 5.1});
  EXPECT_NEAR(fit.slope.value, 0.99, 1e-12);
  EXPECT_NEAR(fit.slope.high - fit.slope.value, 3.182446 * std::sqrt(0.107 / 3 / 10), 1e-5);
}

TEST(LineFit, HoldsTheTruthInNineteenOfTwentyCases) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 0.3);
  int held = 0;
  constexpr int trials = 2000;
  for (int trial = 0; trial < trials; ++trial) {
    std::vector<double> x, y;
    for (int i = 0; i < 24; ++i) {
      x.push_back(i / 8);
      y.push_back(2 - x.back() + noise(random));
    }
    const LineFit fit = fitLine(x, y);
    held += fit.slope.low <= -1 && -1 <= fit.slope.high;
  }
  EXPECT_NEAR(double(held) / trials, 0.95, 0.02);
}

TEST(LineFit, SaysNothingOfTooFewPoints) {
  EXPECT_EQ(fitLine({1, 2}, {1, 2}).points, 0u);
  EXPECT_EQ(fitLine({1, 1, 1}, {1, 2, 3}).points, 0u);
  EXPECT_EQ(fitLine({}, {}).points, 0u);
}

TEST(MeanOf, HasTheIntervalOfStudentsT) {
  const Estimate mean = meanOf({1, 2, 3, 4});
  EXPECT_DOUBLE_EQ(mean.value, 2.5);
  EXPECT_NEAR(mean.high - mean.value, 3.182446 * std::sqrt(5.0 / 3 / 4), 1e-5);
  EXPECT_DOUBLE_EQ(meanOf({7}).low, 7);
}

// The ranks that bound the median with 95 %: 2 and 9 of 10 values.
TEST(MedianOf, HasTheIntervalOfOrderStatistics) {
  const Estimate median = medianOf({10, 9, 8, 7, 6, 5, 4, 3, 2, 1});
  EXPECT_DOUBLE_EQ(median.value, 5.5);
  EXPECT_DOUBLE_EQ(median.low, 2);
  EXPECT_DOUBLE_EQ(median.high, 9);
  const Estimate few = medianOf({3, 1, 2});
  EXPECT_DOUBLE_EQ(few.value, 2);
  EXPECT_DOUBLE_EQ(few.low, 1);
  EXPECT_DOUBLE_EQ(few.high, 3);
}
