//===- Summary.cpp --------------------------------------------------------===//
#include "report/Summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace rtsl::report {

namespace {

using ByLevel = std::map<std::uint32_t, std::vector<const Measurement *>>;

template <typename Field> Estimate medianOver(const std::vector<const Measurement *> &runs, Field field) {
  std::vector<double> values;
  for (const Measurement *run : runs)
    values.push_back(run->*field);
  return medianOf(std::move(values));
}

LevelSummary summariseLevel(const std::vector<const Measurement *> &runs, const Study &study, const Reference &reference) {
  LevelSummary level;
  level.samplesPerPixel = runs.front()->samplesPerPixel;
  level.runs = runs.size();
  level.seconds = medianOver(runs, &Measurement::renderSeconds);
  level.rmse = medianOver(runs, &Measurement::rmse);
  level.relMse = medianOver(runs, &Measurement::relMse);
  level.flip = medianOver(runs, &Measurement::flip);
  level.flipHdr = medianOver(runs, &Measurement::flipHdr);
  for (const LevelVariance &variance : study.levels)
    if (variance.configuration == runs.front()->configuration && variance.samplesPerPixel == level.samplesPerPixel) {
      level.variance = variance.variance;
      level.efficiency = variance.efficiency;
    }
  level.isResolved = !reference.ownError || level.relMse.value > 10 * reference.ownError->relMse;
  return level;
}

void fitLines(SubjectSummary &subject, const ByLevel &byLevel) {
  std::vector<double> seconds, samples, errors;
  for (const LevelSummary &level : subject.levels)
    if (level.isResolved)
      for (const Measurement *run : byLevel.at(level.samplesPerPixel))
        if (run->relMse > 0 && run->renderSeconds > 0) {
          seconds.push_back(std::log10(run->renderSeconds));
          samples.push_back(std::log10(double(run->samplesPerPixel)));
          errors.push_back(std::log10(run->relMse));
        }
  const bool isBlackAndWhite = std::all_of(subject.levels.begin(), subject.levels.end(),
                                           [](const LevelSummary &level) { return level.relMse.value == 0; });
  if (std::set<double>(samples.begin(), samples.end()).size() >= 2) {
    subject.relMseOverSeconds = fitLine(seconds, errors);
    subject.relMseOverSamples = fitLine(samples, errors);
  }
  if (subject.relMseOverSeconds.points == 0)
    subject.noFit = isBlackAndWhite ? "every picture equals the reference, so there is no error to fit"
                                    : "fewer than two numbers of samples have an error that the reference can tell";
}

double medianEfficiency(const std::vector<LevelSummary> &levels) {
  constexpr double longEnough = 0.01; // below, starting threads shows
  std::vector<double> all, slow;
  for (const LevelSummary &level : levels)
    if (std::isfinite(level.efficiency) && level.efficiency > 0) {
      all.push_back(level.efficiency);
      if (level.seconds.value >= longEnough)
        slow.push_back(level.efficiency);
    }
  return medianOf(slow.empty() ? all : slow).value;
}

SubjectSummary summariseSubject(const Subject &subject, const Study &study, const Reference &reference) {
  SubjectSummary summary;
  summary.name = subject.name;
  summary.settings = subject.settings;
  summary.compileSeconds = subject.compileSeconds;
  ByLevel byLevel;
  std::vector<double> builds;
  for (const Measurement &measurement : study.measurements)
    if (measurement.configuration == subject.name) {
      byLevel[measurement.samplesPerPixel].push_back(&measurement);
      builds.push_back(measurement.buildSeconds);
      summary.nanPixels += measurement.nanPixels;
      summary.infinitePixels += measurement.infinitePixels;
      summary.samplesNotFinite += measurement.samplesNotFinite;
    }
  summary.buildSeconds = medianOf(std::move(builds));
  for (const auto &[samples, runs] : byLevel)
    summary.levels.push_back(summariseLevel(runs, study, reference));
  if (reference.problem.empty())
    fitLines(summary, byLevel);
  else
    summary.noFit = "no errors were measured";
  summary.efficiency = medianEfficiency(summary.levels);
  return summary;
}

/// Which pictures are the same bits, at the largest number of samples that every subject reached.
void comparePictures(Summary &summary, const Study &study) {
  std::uint32_t common = std::numeric_limits<std::uint32_t>::max();
  for (const SubjectSummary &subject : summary.subjects)
    common = std::min(common, subject.levels.empty() ? 0 : subject.levels.back().samplesPerPixel);
  for (SubjectSummary &subject : summary.subjects)
    for (const Measurement &measurement : study.measurements)
      if (measurement.configuration == subject.name && measurement.samplesPerPixel == common && measurement.run == 0)
        subject.commonPicture = measurement.pictureHash;
}

void findProblems(Summary &summary, const Reference &reference) {
  std::vector<std::string> &problems = summary.problems;
  if (!reference.problem.empty())
    problems.push_back(reference.problem);
  else if (std::all_of(reference.image.pixels.begin(), reference.image.pixels.end(), [](float value) { return value == 0; }))
    problems.push_back("the reference is black: relMSE is the squared error over a constant here, and FLIP has no exposure to go by");
  if (std::any_of(reference.image.pixels.begin(), reference.image.pixels.end(), [](float v) { return !std::isfinite(v); }) &&
      reference.problem.empty())
    problems.push_back("some pixels of the reference are not finite; they are left out of every error");
  for (const SubjectSummary &subject : summary.subjects) {
    if (subject.nanPixels || subject.infinitePixels)
      problems.push_back(fmt::format("{}: {} pixels were not a number and {} infinite, over all pictures", subject.name,
                                     subject.nanPixels, subject.infinitePixels));
    if (subject.samplesNotFinite)
      problems.push_back(fmt::format("{}: {} samples were not finite and count as black", subject.name, subject.samplesNotFinite));
    const bool isConstant = !subject.levels.empty() && std::all_of(subject.levels.begin(), subject.levels.end(), [](const LevelSummary &level) {
      return level.runs > 1 && level.variance == 0;
    });
    if (isConstant)
      problems.push_back(fmt::format("{}: all runs gave the same picture (zero variance), so its efficiency has no meaning", subject.name));
    if (!subject.noFit.empty())
      problems.push_back(fmt::format("{}: no line was fitted: {}", subject.name, subject.noFit));
    const auto unresolved = std::count_if(subject.levels.begin(), subject.levels.end(), [](const LevelSummary &l) { return !l.isResolved; });
    if (unresolved && reference.ownError)
      problems.push_back(fmt::format("{}: the reference's own error is more than a tenth of that of the last {} numbers of samples, "
                                     "which the line leaves out; a larger `--budget` makes a better reference",
                                     subject.name, unresolved));
  }
}

} // namespace

double SubjectSummary::secondsTo(double relMse) const {
  if (relMseOverSeconds.points == 0 || !(relMse > 0))
    return std::numeric_limits<double>::quiet_NaN();
  return std::pow(10, (std::log10(relMse) - relMseOverSeconds.intercept) / relMseOverSeconds.slope.value);
}

Summary summarise(const std::vector<Subject> &subjects, const Study &study, const Reference &reference) {
  Summary summary;
  for (const Subject &subject : subjects)
    summary.subjects.push_back(summariseSubject(subject, study, reference));
  for (const SubjectSummary &subject : summary.subjects)
    if (subject.relMseOverSeconds.points)
      for (auto level = subject.levels.rbegin(); level != subject.levels.rend(); ++level)
        if (level->isResolved) {
          summary.commonRelMse = std::max(summary.commonRelMse, level->relMse.value);
          break;
        }
  comparePictures(summary, study);
  findProblems(summary, reference);
  return summary;
}

} // namespace rtsl::report
