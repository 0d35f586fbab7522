//===- Study.h - error against run time, measured -------------------------===//
//
// Renders each subject with 1, 2, 4, ... samples per pixel, several independent runs each, and
// compares every picture with the reference. The runs are made in rounds: a round has each number
// of samples once, for every subject in turn, and each round has its own order. So a machine that
// becomes slower, or is busy for a while, affects all subjects and all numbers of samples alike,
// and its changes between rounds appear in the differences between rounds (LineFit.h).
//
//===----------------------------------------------------------------------===//
#pragma once

#include "report/Measurement.h"
#include "report/Reference.h"
#include "report/Subject.h"

#include <atomic>
#include <string>
#include <vector>

namespace rtsl::report {

struct StudyOptions {
  std::string folder; // keeps measurements.csv, levels.csv, pictures/ and, while running, partial/
  std::uint32_t runs = 8;    // with each number of samples: the rounds
  double budgetSeconds = 10; // of rendering, for each subject; the first three levels always run
  std::uint32_t mostSamples = 1u << 16;
  ProgressFunction progress = [](double, const std::string &) {};
};

struct Study {
  std::vector<Measurement> measurements; // in the order in which they were made
  std::vector<LevelVariance> levels;
};

/// The order of levels in a round: ascending in the first, which finds the number of levels, and
/// then random, so that no disturbance can be synchronous with it. Deterministic.
std::vector<unsigned> levelOrder(std::uint32_t round, unsigned levels);

/// The picture of a subject with the most samples so far, first run.
std::string lastPicturePath(const std::string &folder, const Subject &subject);

/// Continues an interrupted study in the same folder; pictures that were measured are not measured
/// again.
Study runStudy(const std::vector<Subject> &subjects, const Reference &reference,
               const StudyOptions &options);

} // namespace rtsl::report
