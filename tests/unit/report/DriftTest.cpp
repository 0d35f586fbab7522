// Studies on simulated machines: run times and errors follow laws that are known, the machine's
// speed drifts, and the intervals that a study gives are held against the truth.
#include "report/Study.h"
#include "report/Summary.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

using namespace rtsl::report;

namespace {

constexpr unsigned levels = 7, rounds = 8;
constexpr double secondsPerSample = 1e-2;
constexpr unsigned repeats = 1000;

/// The logarithm (base 10) of how much slower a machine is, over time in seconds.
using Drift = std::function<double(double)>;
using MakeDrift = std::function<Drift(std::mt19937 &)>;

/// A study as Study.cpp orders it, on a machine that drifts. Errors fall with the samples to the
/// power of `slope`.
class SimulatedStudy {
public:
  double slope = -1, errorNoise = 0.02, timeNoise = 0.01;
  double floor = 0, overhead = 0;  // of the relMSE, and seconds of starting a picture
  bool takesLevelsInOrder = false; // all runs of a level together: as it should not be done

  Study run(const MakeDrift &makeDrift, std::mt19937 &random,
            std::vector<double> slownesses = {1}) const {
    const Drift drift = makeDrift(random);
    std::normal_distribution<double> normal(0, 1);
    Study study;
    double clock = 0;
    const auto measure = [&](unsigned level, unsigned round) {
      const double samples = std::exp2(level);
      const double relMse =
          (0.1 * std::pow(samples, slope) + floor) * std::pow(10, errorNoise * normal(random));
      for (std::size_t i = 0; i < slownesses.size(); ++i) {
        Measurement one;
        one.configuration = nameOf(i);
        one.samplesPerPixel = 1u << level;
        one.run = round;
        const double quiet = slownesses[i] * secondsPerSample * samples + overhead;
        one.renderSeconds =
            quiet * std::pow(10, drift(clock + quiet / 2) + timeNoise * normal(random));
        one.relMse = relMse;
        clock += one.renderSeconds;
        study.measurements.push_back(one);
      }
    };
    if (takesLevelsInOrder) {
      for (unsigned level = 0; level < levels; ++level)
        for (unsigned round = 0; round < rounds; ++round)
          measure(level, round);
    } else {
      for (unsigned round = 0; round < rounds; ++round)
        for (unsigned level : levelOrder(round, levels))
          measure(level, round);
    }
    return study;
  }

  static std::string nameOf(std::size_t i) { return "configuration " + std::to_string(i); }

  Summary summary(const MakeDrift &makeDrift, std::mt19937 &random,
                  const std::vector<double> &slownesses = {1}) const {
    std::vector<Subject> subjects(slownesses.size());
    for (std::size_t i = 0; i < subjects.size(); ++i)
      subjects[i].name = nameOf(i);
    return summarise(subjects, run(makeDrift, random, slownesses), {});
  }
};

Drift quiet(std::mt19937 &) {
  return [](double) { return 0.0; };
}

/// A sum of steps at random times, as of other processes that begin and end.
Drift busy(std::mt19937 &random) {
  std::uniform_real_distribution<double> when(0, 12);
  std::normal_distribution<double> how(0, 0.08);
  std::vector<std::pair<double, double>> steps;
  for (int i = 0; i < 12; ++i)
    steps.push_back({when(random), how(random)});
  return [steps](double time) {
    double sum = 0;
    for (const auto &[at, size] : steps)
      sum += time >= at ? size : 0;
    return sum;
  };
}

/// Fourier components of random phase, longer ones stronger: what wanders slowly.
Drift wandering(std::mt19937 &random) {
  std::uniform_real_distribution<double> phase(0, 6.2831853), period(0.3, 20);
  std::vector<std::array<double, 3>> waves;
  for (int i = 0; i < 20; ++i) {
    const double length = period(random);
    waves.push_back({6.2831853 / length, phase(random), 0.01 * std::sqrt(length)});
  }
  return [waves](double time) {
    double sum = 0;
    for (const auto &[frequency, phase, size] : waves)
      sum += size * std::sin(frequency * time + phase);
    return sum;
  };
}

/// It grows warm and slows down.
Drift warming(std::mt19937 &) {
  return [](double time) { return 0.15 * (1 - std::exp(-time / 4)); };
}

struct Machine {
  const char *name;
  MakeDrift drift;
};
const Machine machines[] = {
    {"quiet", quiet}, {"busy", busy}, {"wandering", wandering}, {"warming", warming}};

/// Whether intervals held the truth in 95 % of the repeats: not in fewer than chance allows (3.3
/// standard deviations of the binomial distribution), and not in nearly all, as intervals would
/// that are of no use.
void expectCoverage(unsigned held, const std::string &what) {
  const double deviation = std::sqrt(repeats * 0.95 * 0.05);
  EXPECT_GE(held, repeats * 0.95 - 3.3 * deviation) << what;
  EXPECT_LE(held, repeats * 0.99) << what;
}

bool holds(const Estimate &estimate, double truth) {
  return estimate.low <= truth && truth <= estimate.high;
}

/// The interval of a least-squares slope over points that are taken for independent.
Estimate independentSlope(const Study &study) {
  std::vector<double> x, y;
  double meanX = 0, meanY = 0;
  for (const Measurement &one : study.measurements) {
    x.push_back(std::log10(one.renderSeconds));
    y.push_back(std::log10(one.relMse));
    meanX += x.back() / double(study.measurements.size());
    meanY += y.back() / double(study.measurements.size());
  }
  double xx = 0, xy = 0, squares = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - meanX) * (x[i] - meanX);
    xy += (x[i] - meanX) * (y[i] - meanY);
  }
  for (std::size_t i = 0; i < x.size(); ++i)
    squares += std::pow(y[i] - meanY - xy / xx * (x[i] - meanX), 2);
  const double halfWidth = 2.005 * std::sqrt(squares / double(x.size() - 2) / xx);
  return {xy / xx, xy / xx - halfWidth, xy / xx + halfWidth};
}

} // namespace

TEST(Drift, SlopesOverSecondsHoldTheTruth) {
  for (const Machine &machine : machines)
    for (double slope : {-1.0, -1.3}) {
      std::mt19937 random(7);
      SimulatedStudy study;
      study.slope = slope;
      unsigned held = 0;
      for (unsigned repeat = 0; repeat < repeats; ++repeat)
        held += holds(study.summary(machine.drift, random).subjects.front().relMseOverSeconds.slope,
                      slope);
      expectCoverage(held, std::string(machine.name) + ", slope " + std::to_string(slope));
    }
}

TEST(Drift, SlopesOverSamplesHoldTheTruth) {
  std::mt19937 random(8);
  unsigned held = 0;
  for (unsigned repeat = 0; repeat < repeats; ++repeat)
    held +=
        holds(SimulatedStudy().summary(busy, random).subjects.front().relMseOverSamples.slope, -1);
  expectCoverage(held, "over samples");
}

// What is held against the truth here can miss it: runs of a level together, taken for independent.
TEST(Drift, PointsThatAreTakenForIndependentMissTheTruth) {
  std::mt19937 random(7);
  SimulatedStudy study;
  study.takesLevelsInOrder = true;
  unsigned held = 0;
  for (unsigned repeat = 0; repeat < repeats; ++repeat)
    held += holds(independentSlope(study.run(busy, random)), -1);
  EXPECT_LT(held, repeats * 0.7);
}

TEST(Drift, TimesToAnErrorHoldTheTruthWhereTheCurveBends) {
  for (const Machine &machine : {machines[0], machines[1], machines[2]}) {
    std::mt19937 random(9);
    SimulatedStudy study;
    study.overhead = 0.03; // which three samples take
    study.floor = 2e-3;    // that of 50 samples
    unsigned held = 0, bent = 0, heldRatio = 0;
    for (unsigned repeat = 0; repeat < repeats; ++repeat) {
      const Summary summary = study.summary(machine.drift, random, {1, 1.25});
      bent += summary.subjects[0].relMseOverSeconds.bends();
      // The logarithm of seconds is straight over that of errors between two levels: that is the
      // truth which is interpolated.
      const auto truth = [&](double slowness) {
        const auto error = [&](double level) {
          return std::log10(0.1 * std::exp2(-level) + study.floor);
        };
        const auto seconds = [&](double level) {
          return std::log10(slowness * secondsPerSample * std::exp2(level) + study.overhead);
        };
        const double y = std::log10(summary.commonRelMse);
        for (unsigned level = 1; level < levels; ++level)
          if (error(level) <= y || level + 1 == levels) {
            const double share = (y - error(level - 1)) / (error(level) - error(level - 1));
            return std::pow(10, seconds(level - 1) + share * (seconds(level) - seconds(level - 1)));
          }
        return 0.0;
      };
      held += machine.name == machines[0].name && summary.subjects[0].toCommonRelMse &&
              holds(summary.subjects[0].toCommonRelMse->seconds, truth(1));
      heldRatio += summary.subjects[1].timesTheQuickest &&
                   holds(*summary.subjects[1].timesTheQuickest, truth(1.25) / truth(1));
    }
    EXPECT_GE(bent, repeats * 0.95) << machine.name;
    if (machine.name == machines[0].name) // a machine that drifts has no one time
      expectCoverage(held, std::string("time to an error, ") + machine.name);
    expectCoverage(heldRatio, std::string("ratio of times, ") + machine.name);
  }
}
