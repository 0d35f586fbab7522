// Whether rare, large samples are found, and whether what is said of the error of the others is
// true.
#include "report/measures/HeavyTail.h"
#include "report/Page.h"
#include "report/Reference.h"
#include "report/Summary.h"
#include "report/measures/ErrorMetrics.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <filesystem>
#include <functional>
#include <random>

using namespace rtsl;
using namespace rtsl::report;
using runtime::Image;

namespace {

constexpr std::uint32_t width = 40, height = 30, runs = 32;

/// One run's mean of so many samples of a pixel.
using Pixel = std::function<double(std::mt19937 &, std::size_t pixel)>;

RunningVariance runsOf(const Pixel &pixel, std::uint32_t count = runs) {
  std::mt19937 random(5);
  RunningVariance spread;
  for (std::uint32_t run = 0; run < count; ++run) {
    Image image(width, height, 1);
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
      image.pixels[i] = float(pixel(random, i));
    spread.add(image);
  }
  return spread;
}

double normal(std::mt19937 &random, double mean, double deviation) {
  return std::normal_distribution<double>(mean, deviation)(random);
}

/// The mean of `samples` that are `value` with a probability, and 0 otherwise.
double rare(std::mt19937 &random, int samples, double probability, double value) {
  return std::binomial_distribution<int>(samples, probability)(random) * value / samples;
}

/// The mean of samples with the tail index `index`, from 1 up.
double pareto(std::mt19937 &random, int samples, double index) {
  std::uniform_real_distribution<double> uniform(0, 1);
  double sum = 0;
  for (int i = 0; i < samples; ++i)
    sum += std::pow(1 - uniform(random), -1 / index);
  return sum / samples;
}

struct Law {
  const char *name;
  Pixel pixel;
};

const Law heavy[] = {
    {"one sample in a million, and most pixels meet none",
     [](std::mt19937 &random, std::size_t) {
       return 0.1 + rare(random, 4000, 1e-6, 1e6) + normal(random, 0, 0.002);
     }},
    {"two events a thousand pixels",
     [](std::mt19937 &random, std::size_t) {
       return 0.5 + rare(random, 100, 6e-7, 1e5) + normal(random, 0, 0.01);
     }},
    {"no variance (tail index 1.2)",
     [](std::mt19937 &random, std::size_t) { return pareto(random, 16, 1.2); }},
    {"no variance (tail index 1.5)",
     [](std::mt19937 &random, std::size_t) { return pareto(random, 16, 1.5); }},
};

const Law light[] = {
    {"normal", [](std::mt19937 &random, std::size_t) { return normal(random, 0.5, 0.1); }},
    {"normal, with noise from 1e-4 to 1 and means from 0 to 3",
     [](std::mt19937 &random, std::size_t i) {
       return normal(random, double(i % 7) / 2, std::pow(10, -double(i % 5)));
     }},
    {"noise in ten pixels only",
     [](std::mt19937 &random, std::size_t i) {
       return i % 120 == 0 ? normal(random, 0.5, 0.3) : 0.25;
     }},
    {"edges: 0 or 1 with probabilities from 2 % to 98 %",
     [](std::mt19937 &random, std::size_t i) {
       return rare(random, 16, 0.02 + 0.96 * double(i) / (width * height), 1);
     }},
    {"fireflies that each run meets",
     [](std::mt19937 &random, std::size_t) { return rare(random, 4000, 1e-3, 100); }},
    {"tail index 4", [](std::mt19937 &random, std::size_t) { return pareto(random, 64, 4); }},
};

} // namespace

TEST(HeavyTail, IsFoundWhereItIs) {
  for (const Law &law : heavy) {
    const TailEvidence tail = findTail(runsOf(law.pixel));
    EXPECT_TRUE(tail.isHeavy()) << law.name << ": " << tail.text();
  }
}

TEST(HeavyTail, IsNotFoundWhereItIsNot) {
  for (const Law &law : light)
    for (std::uint32_t count : {8u, 16u, runs}) {
      const TailEvidence tail = findTail(runsOf(law.pixel, count));
      EXPECT_FALSE(tail.isHeavy()) << law.name << ", " << count << " runs: " << tail.text();
    }
}

// What is said of the error of a mean is true where no tail is found.
TEST(HeavyTail, LightTailsHaveTheErrorThatIsClaimed) {
  for (const Law &law : light) {
    const RunningVariance spread = runsOf(law.pixel);
    const double claimed = std::sqrt(spread.meanVariance() / runs);
    double squares = 0; // against the mean of many more
    const RunningVariance truth =
        runsOf([&, other = std::mt19937(77)](std::mt19937 &,
                                             std::size_t i) mutable { return law.pixel(other, i); },
               40 * runs);
    const ErrorMetrics error = measureError(truth.mean(), spread.mean());
    squares = error.rmse;
    EXPECT_NEAR(squares / claimed, 1, 0.35) << law.name;
  }
}

// Grubbs' table has 2.274 for 8 values and 1 % on one side; its squares by 7 of sums.
TEST(HeavyTail, MatchesANormalDistribution) {
  EXPECT_EQ(normalMaximumShare(2), 1);
  EXPECT_GT(normalMaximumShare(8), 2.274 * 2.274 / 7);
  EXPECT_LT(normalMaximumShare(8), 7.0 / 8);
  std::mt19937 random(1);
  constexpr unsigned trials = 100000;
  unsigned above = 0;
  for (unsigned trial = 0; trial < trials; ++trial) {
    double values[16], mean = 0, squares = 0, largest = 0;
    for (double &value : values)
      mean += (value = normal(random, 0, 1)) / 16;
    for (double value : values) {
      squares += (value - mean) * (value - mean);
      largest = std::max(largest, (value - mean) * (value - mean));
    }
    above += largest / squares > normalMaximumShare(16);
  }
  EXPECT_NEAR(above, trials * 1e-3, 35);
}

TEST(HeavyTail, HillFindsTheIndex) {
  std::mt19937 random(2);
  std::vector<double> values(100000);
  for (double &value : values)
    value = pareto(random, 1, 1.5);
  EXPECT_NEAR(hillIndex(values, 500), 1.5, 0.2);
  EXPECT_TRUE(std::isinf(hillIndex({1, 2}, 5)));
}

// As it was found: an event of probability 1e-6 in about 120 thousand samples a pixel, of which an
// eighth of the pixels meets one. The claim rests on means that the events themselves have raised.
TEST(HeavyTail, AReferenceWithRareHotSamplesClaimsNothing) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "rtsl-heavy-tail";
  std::filesystem::create_directories(folder);
  Subject subject;
  subject.name = "rare";
  subject.render = [](std::uint32_t samples, std::uint32_t seed) {
    std::mt19937 random(seed);
    Picture picture;
    picture.image = Image(width, height, 3);
    for (std::size_t i = 0; i < picture.image.pixels.size(); ++i)
      picture.image.pixels[i] = float(0.05 + rare(random, int(samples), 1e-6, 1e6) +
                                      normal(random, 0, 0.1 / std::sqrt(double(samples))));
    picture.statistics.renderSeconds = 1e-6 * samples;
    return picture;
  };
  const Reference made = makeReference(subject, subject, folder.string(), runs, 0.12,
                                       [](double, const std::string &) {});
  ASSERT_TRUE(made.ownError);
  EXPECT_NEAR(double(made.ownError->samplesPerPixel) * runs, 120000, 30000);
  EXPECT_TRUE(made.ownError->tail.isHeavy()) << made.ownError->tail.text();
  EXPECT_TRUE(std::isnan(made.ownError->rmse) && std::isnan(made.ownError->relMse));
  EXPECT_NE(made.origin.find("its error cannot be estimated"), std::string::npos) << made.origin;
  const std::optional<Reference> again = findReference("rare", folder.string());
  ASSERT_TRUE(again && again->ownError->tail.isHeavy());
  EXPECT_EQ(again->origin, made.origin);

  StudyOptions options;
  options.folder = folder.string();
  options.budgetSeconds = 1e-3;
  const Summary summary = summarise({subject}, runStudy({subject}, made, options), made);
  EXPECT_EQ(summary.subjects[0].relMseOverSeconds.points, 0u);
  EXPECT_FALSE(summary.subjects[0].toCommonRelMse);
  ASSERT_FALSE(summary.problems.empty());
  EXPECT_NE(summary.problems.front().find("no interval can be given"), std::string::npos);
  EXPECT_NE(writePage({}, summary, made, {}).find("no interval can be given"), std::string::npos);
  const nlohmann::json document = nlohmann::json::parse(writeJson({}, summary, made));
  EXPECT_TRUE(document["reference"]["ownError"]["heavyTails"].get<bool>());
  EXPECT_TRUE(document["reference"]["ownError"]["relMse"].is_null());
  EXPECT_TRUE(document["heavyTails"].is_string());
  const nlohmann::json &level = document["configurations"][0]["levels"][0];
  EXPECT_TRUE(level["relMse"]["value"].is_number() && level["relMse"]["low"].is_null() &&
              level["relMse"]["high"].is_null());
  EXPECT_TRUE(document["configurations"][0]["relMseOverSeconds"].is_null());
  std::filesystem::remove_all(folder);
}

// A given reference has no statistics of its runs, but the runs of the study have.
TEST(HeavyTail, RunsThatDifferManyTimesHaveNoInterval) {
  Study study;
  for (std::uint32_t run = 0; run < 8; ++run)
    for (std::uint32_t samples : {1u, 2u, 4u}) {
      Measurement one;
      one.configuration = "strict";
      one.samplesPerPixel = samples;
      one.run = run;
      one.renderSeconds = samples;
      one.relMse = (run == 3 ? 9.0 : 1.0 + 0.01 * run) / samples;
      study.measurements.push_back(one);
    }
  Subject subject;
  subject.name = "strict";
  const Summary summary = summarise({subject}, study, {});
  EXPECT_FALSE(summary.heavyTails.empty());
  EXPECT_EQ(summary.subjects[0].relMseOverSeconds.points, 0u);
}
