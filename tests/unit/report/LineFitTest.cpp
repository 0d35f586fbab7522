#include "report/measures/LineFit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

using namespace rtsl::report;

namespace {

/// `count` rounds of measurements at these x, which are known without error.
Rounds measure(const std::vector<double> &x, unsigned count,
               const std::function<double(double)> &y) {
  Rounds rounds;
  rounds.effort = x;
  for (double one : x) {
    rounds.x.emplace_back(count, one);
    rounds.y.emplace_back();
    for (unsigned round = 0; round < count; ++round)
      rounds.y.back().push_back(y(one));
  }
  return rounds;
}

constexpr unsigned trials = 2000;

/// Whether so many of `trials` are what chance makes of a probability: within 3.3 standard
/// deviations.
void expectShare(unsigned count, double probability) {
  const double deviation = std::sqrt(trials * probability * (1 - probability));
  EXPECT_NEAR(count, trials * probability, 3.3 * deviation);
}

} // namespace

TEST(LineFit, FindsALine) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 1e-9);
  const LineFit fit =
      fitLine(measure({0, 1, 2, 3}, 4, [&](double x) { return 5 - x + noise(random); }));
  EXPECT_EQ(fit.points, 16u);
  EXPECT_EQ(fit.rounds, 4u);
  EXPECT_NEAR(fit.slope.value, -1, 1e-8);
  EXPECT_NEAR(fit.intercept, 5, 1e-8);
  EXPECT_NEAR(fit.slope.high - fit.slope.low, 0, 1e-7);
  EXPECT_NEAR(fit.at(10).value, -5, 1e-7);
}

// With two levels the slope of a round is a difference: 1.0, 1.2 and 0.8, and t of 2 degrees
// has 4.302653 at 97.5 %.
TEST(LineFit, HasTheIntervalOfStudentsTOverRounds) {
  const LineFit fit = fitLine({{0, 1}, {{0, 0, 0}, {1, 1, 1}}, {{7, 5, 3}, {8, 6.2, 3.8}}});
  EXPECT_NEAR(fit.slope.value, 1, 1e-12);
  EXPECT_NEAR(fit.slope.high - fit.slope.value, 4.302653 * 0.2 / std::sqrt(3.0), 1e-5)
      << "the heights of the rounds play no part";
  const Estimate left = fit.at(0);
  EXPECT_NEAR(left.value, 5, 1e-12);
  EXPECT_NEAR(left.high - left.value, 4.302653 * 2 / std::sqrt(3.0), 1e-5) << "and here they do";
}

TEST(LineFit, HoldsTheTruthInNineteenOfTwentyCases) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 0.3);
  unsigned held = 0, heldInTheMiddle = 0, bent = 0;
  for (unsigned trial = 0; trial < trials; ++trial) {
    const LineFit fit =
        fitLine(measure({0, 1, 2, 3, 4}, 8, [&](double x) { return 2 - x + noise(random); }));
    held += fit.slope.low <= -1 && -1 <= fit.slope.high;
    heldInTheMiddle += fit.at(2.5).low <= -0.5 && -0.5 <= fit.at(2.5).high;
    bent += fit.bends();
  }
  expectShare(held, 0.95);
  expectShare(heldInTheMiddle, 0.95);
  EXPECT_LE(bent, trials * 0.01 + 3.3 * std::sqrt(trials * 0.01))
      << "a straight line seldom seems to bend";
}

// Least squares of y over a noisy x would find a slope that is too flat: here by a factor of 0.86.
TEST(LineFit, IsNotFlattenedByNoiseOfX) {
  std::mt19937 random(2);
  std::normal_distribution<double> noise(0, 0.2);
  unsigned held = 0;
  for (unsigned trial = 0; trial < trials; ++trial) {
    Rounds rounds =
        measure({0, 0.5, 1, 1.5}, 8, [&](double x) { return -x + 0.1 * noise(random); });
    for (std::vector<double> &level : rounds.x)
      for (double &x : level)
        x += noise(random);
    const LineFit fit = fitLine(rounds);
    held += fit.slope.low <= -1 && -1 <= fit.slope.high;
  }
  expectShare(held, 0.95);
}

TEST(LineFit, FindsABend) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, 0.02);
  const auto bends = [&](const std::function<double(double)> &curve) {
    return fitLine(measure({0, 0.3, 0.6, 0.9, 1.2, 1.5}, 8,
                           [&](double x) { return curve(x) + noise(random); }));
  };
  EXPECT_FALSE(bends([](double x) { return -x; }).bends());
  const LineFit floored = bends([](double x) { return std::log10(std::pow(10, -x) + 0.1); });
  EXPECT_TRUE(floored.bends());
  EXPECT_GT(floored.largestResidual, 0.02);
  EXPECT_TRUE(bends([](double x) { return -x + 0.1 * std::sin(4 * x); }).bends())
      << "an S has no curvature as a whole";
  EXPECT_EQ(bends([](double x) { return -x; }).lackOfFit <= 1, true);
}

TEST(LineFit, HasNoResultForTooFewPoints) {
  EXPECT_EQ(fitLine({}).points, 0u);
  EXPECT_EQ(fitLine({{0}, {{1, 2}}, {{1, 2}}}).points, 0u) << "one level";
  EXPECT_EQ(fitLine({{0, 1}, {{1}, {2}}, {{1}, {2}}}).points, 0u) << "one round";
  EXPECT_EQ(fitLine({{0, 1}, {{1, 1}, {1, 1}}, {{1, 1}, {2, 2}}}).points, 0u) << "no extent";
}

TEST(Crossing, LiesBetweenTheLevelsOnBothSides) {
  // y = 4, 2, 1 at x = 0, 1, 3.
  const Rounds rounds = {{0, 1, 2}, {{0, 0}, {1, 1}, {3, 3}}, {{4, 4}, {2, 2}, {1, 1}}};
  const auto at = [&](double y) { return findCrossing(rounds, y)->estimate().value; };
  EXPECT_NEAR(at(3), 0.5, 1e-12);
  EXPECT_NEAR(at(2), 1, 1e-12);
  EXPECT_NEAR(at(1.5), 2, 1e-12);
  EXPECT_NEAR(at(1), 3, 1e-12);
  EXPECT_FALSE(findCrossing(rounds, 0.5));
  EXPECT_FALSE(findCrossing(rounds, 3)->isBound);
  EXPECT_TRUE(findCrossing(rounds, 5)->isBound);
  EXPECT_NEAR(at(5), 0, 1e-12);
}

TEST(Crossing, HoldsTheTruthInNineteenOfTwentyCases) {
  std::mt19937 random(4);
  std::normal_distribution<double> noise(0, 0.05);
  unsigned held = 0;
  for (unsigned trial = 0; trial < trials; ++trial) {
    Rounds rounds =
        measure({0, 0.3, 0.6, 0.9}, 8, [&](double x) { return -x * x + noise(random); });
    for (unsigned round = 0; round < 8; ++round) {
      const double shared = noise(random); // a busy machine
      for (std::vector<double> &level : rounds.x)
        level[round] += shared + 0.2 * noise(random);
    }
    // between 0.36 and 0.81, the middle
    const Estimate crossing = findCrossing(rounds, -0.585)->estimate();
    held += crossing.low <= 0.75 && 0.75 <= crossing.high;
  }
  expectShare(held, 0.95);
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
