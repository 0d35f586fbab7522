//===- Summary.cpp --------------------------------------------------------===//
#include "report/Summary.h"

#include "report/measures/Exposure.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace rtsl::report {

namespace {

using ByLevel = std::map<std::uint32_t, std::vector<const Measurement *>>;

template <typename Field>
Estimate medianOver(const std::vector<const Measurement *> &runs, Field field) {
  std::vector<double> values;
  for (const Measurement *run : runs)
    values.push_back(run->*field);
  return medianOf(std::move(values));
}

LevelSummary summariseLevel(const std::vector<const Measurement *> &runs, const Study &study,
                            const Reference &reference) {
  LevelSummary level;
  level.samplesPerPixel = runs.front()->samplesPerPixel;
  level.runs = runs.size();
  level.seconds = medianOver(runs, &Measurement::renderSeconds);
  level.rmse = medianOver(runs, &Measurement::rmse);
  level.relMse = medianOver(runs, &Measurement::relMse);
  level.flip = medianOver(runs, &Measurement::flip);
  level.flipHdr = medianOver(runs, &Measurement::flipHdr);
  for (const LevelVariance &variance : study.levels)
    if (variance.configuration == runs.front()->configuration &&
        variance.samplesPerPixel == level.samplesPerPixel) {
      level.variance = variance.variance;
      level.efficiency = variance.efficiency;
    }
  level.isResolved = !reference.ownError || level.relMse.value > 10 * reference.ownError->relMse;
  return level;
}

/// log10 of seconds and of relMSE, less the reference's own, at the levels of a subject that the
/// reference can resolve.
Rounds roundsOf(const SubjectSummary &subject, const ByLevel &byLevel, const Reference &reference) {
  const double own = reference.ownError ? reference.ownError->relMse : 0;
  Rounds rounds;
  for (const LevelSummary &level : subject.levels) {
    const std::vector<const Measurement *> &runs = byLevel.at(level.samplesPerPixel);
    const bool isWhole = runs.size() == subject.levels.front().runs &&
                         std::all_of(runs.begin(), runs.end(), [&](const Measurement *run) {
                           return run->relMse > own && run->renderSeconds > 0;
                         });
    if (!level.isResolved || !isWhole)
      continue;
    rounds.effort.push_back(std::log10(double(level.samplesPerPixel)));
    rounds.x.emplace_back();
    rounds.y.emplace_back();
    for (const Measurement *run : runs) {
      rounds.x.back().push_back(std::log10(run->renderSeconds));
      rounds.y.back().push_back(std::log10(run->relMse - own));
    }
  }
  return rounds;
}

/// The same over samples.
Rounds overSamples(Rounds rounds) {
  for (std::size_t level = 0; level < rounds.levels(); ++level)
    rounds.x[level].assign(rounds.rounds(), rounds.effort[level]);
  return rounds;
}

constexpr std::size_t lastLevels = 3;

std::optional<Estimate> lastSlope(const LineFit &whole, const Rounds &rounds) {
  if (!whole.bends() || rounds.levels() <= lastLevels)
    return std::nullopt;
  return fitLine(rounds.part(rounds.levels() - lastLevels, rounds.levels())).slope;
}

void fitLines(SubjectSummary &subject, const Rounds &rounds) {
  subject.relMseOverSeconds = fitLine(rounds);
  subject.relMseOverSamples = fitLine(overSamples(rounds));
  subject.lastSlopeOverSeconds = lastSlope(subject.relMseOverSeconds, rounds);
  subject.lastSlopeOverSamples = lastSlope(subject.relMseOverSamples, overSamples(rounds));
  if (subject.relMseOverSeconds.points != 0)
    return;
  const bool isBlackAndWhite =
      std::all_of(subject.levels.begin(), subject.levels.end(),
                  [](const LevelSummary &level) { return level.relMse.value == 0; });
  subject.noFit =
      isBlackAndWhite
          ? "every picture equals the reference, so there is no error to fit"
          : "fewer than two numbers of samples have an error that the reference can measure";
}

Estimate powerOfTen(const Estimate &logarithm) {
  return {std::pow(10, logarithm.value), std::pow(10, logarithm.low), std::pow(10, logarithm.high)};
}

/// 10 to the difference of two logarithms that were measured in the same rounds.
Estimate pairedRatio(const std::vector<double> &above, const std::vector<double> &below) {
  std::vector<double> differences;
  for (std::size_t round = 0; round < std::min(above.size(), below.size()); ++round)
    differences.push_back(above[round] - below[round]);
  return powerOfTen(meanOf(differences));
}

double meanError(const Rounds &rounds, std::size_t level) {
  return meanOf(rounds.y[level]).value;
}

/// The time of another subject relative to the first, at each of its levels.
void compareWithFirst(const Rounds &first, const Rounds &other, SubjectSummary &subject) {
  for (std::size_t i = 0; i < other.levels(); ++i) {
    const double error = meanError(other, i);
    const std::optional<Crossing> its = findCrossing(other, error),
                                  firsts = findCrossing(first, error);
    if (!its || !firsts || its->isBound || firsts->isBound)
      continue;
    for (LevelSummary &level : subject.levels)
      if (std::log10(double(level.samplesPerPixel)) == other.effort[i])
        level.timesTheFirst = pairedRatio(its->perRound, firsts->perRound);
  }
}

/// Finds an error that all subjects reached, and when they reached it.
void findTimes(Summary &summary, const std::vector<Rounds> &rounds) {
  double common = -std::numeric_limits<double>::infinity();
  for (const Rounds &one : rounds)
    if (one.levels() >= 2)
      common = std::max(common, meanError(one, one.levels() - 1));
  if (!std::isfinite(common))
    return;
  summary.commonRelMse = std::pow(10, common);
  const std::vector<double> *quickest = nullptr;
  std::vector<std::optional<Crossing>> crossings;
  for (const Rounds &one : rounds)
    crossings.push_back(one.levels() >= 2 ? findCrossing(one, common) : std::nullopt);
  for (std::size_t i = 0; i < rounds.size(); ++i)
    if (crossings[i]) {
      summary.subjects[i].toCommonRelMse =
          TimeToError{powerOfTen(crossings[i]->estimate()), crossings[i]->isBound};
      if (!quickest || meanOf(crossings[i]->perRound).value < meanOf(*quickest).value)
        quickest = &crossings[i]->perRound;
    }
  for (std::size_t i = 0; i < rounds.size(); ++i)
    if (crossings[i] && !crossings[i]->isBound)
      summary.subjects[i].timesTheQuickest = pairedRatio(crossings[i]->perRound, *quickest);
}

double medianEfficiency(const std::vector<LevelSummary> &levels) {
  constexpr double longEnough = 0.01; // below, the time of starting threads matters
  std::vector<double> all, slow;
  for (const LevelSummary &level : levels)
    if (std::isfinite(level.efficiency) && level.efficiency > 0) {
      all.push_back(level.efficiency);
      if (level.seconds.value >= longEnough)
        slow.push_back(level.efficiency);
    }
  return medianOf(slow.empty() ? all : slow).value;
}

SubjectSummary summariseSubject(const Subject &subject, const Study &study,
                                const Reference &reference, ByLevel &byLevel) {
  SubjectSummary summary;
  summary.name = subject.name;
  summary.settings = subject.settings;
  summary.compileSeconds = subject.compileSeconds;
  std::vector<double> builds;
  for (const Measurement &measurement : study.measurements)
    if (measurement.configuration == subject.name) {
      byLevel[measurement.samplesPerPixel].push_back(&measurement);
      builds.push_back(measurement.buildSeconds);
      summary.nanPixels += measurement.nanPixels;
      summary.infinitePixels += measurement.infinitePixels;
      summary.samplesNotFinite += measurement.samplesNotFinite;
      summary.raysTooDeep += measurement.raysTooDeep;
    }
  summary.buildSeconds = medianOf(std::move(builds));
  for (auto &[samples, runs] : byLevel) {
    std::sort(runs.begin(), runs.end(),
              [](const Measurement *a, const Measurement *b) { return a->run < b->run; });
    summary.levels.push_back(summariseLevel(runs, study, reference));
  }
  summary.efficiency = medianEfficiency(summary.levels);
  return summary;
}

/// The largest ratio of the largest to the median error of a level's runs, over all subjects.
double largestSpread(const Study &study) {
  std::map<std::pair<std::string, std::uint32_t>, std::vector<double>> errors;
  for (const Measurement &measurement : study.measurements)
    errors[{measurement.configuration, measurement.samplesPerPixel}].push_back(measurement.relMse);
  double spread = 0;
  for (auto &[level, values] : errors)
    if (const double median = medianOf(values).value; median > 0)
      spread = std::max(spread, *std::max_element(values.begin(), values.end()) / median);
  return spread;
}

/// Why errors have no intervals, or empty.
std::string findHeavyTails(const Study &study, const Reference &reference) {
  if (reference.ownError && reference.ownError->tail.isHeavy())
    return "the runs of the reference: " + reference.ownError->tail.text();
  constexpr double muchMore = 4; // a mean over pixels with light tails is far below
  if (const double spread = largestSpread(study); spread > muchMore)
    return fmt::format(
        "of the runs with one number of samples one has {:.2g} times the median error", spread);
  return {};
}

/// Removes all results that depend on intervals, and keeps the measured errors.
void dropIntervals(Summary &summary) {
  for (SubjectSummary &subject : summary.subjects) {
    subject.noFit = "rare, large samples dominate the errors";
    subject.efficiency = std::numeric_limits<double>::quiet_NaN();
    for (LevelSummary &level : subject.levels) {
      level.efficiency = std::numeric_limits<double>::quiet_NaN();
      for (Estimate *error : {&level.rmse, &level.relMse, &level.flip, &level.flipHdr})
        error->low = error->high = std::numeric_limits<double>::quiet_NaN();
    }
  }
}

/// Finds which pictures have the same bits, at the largest number of samples that every subject
/// reached.
void comparePictures(Summary &summary, const Study &study) {
  std::uint32_t common = std::numeric_limits<std::uint32_t>::max();
  for (const SubjectSummary &subject : summary.subjects)
    common = std::min(common, subject.levels.empty() ? 0 : subject.levels.back().samplesPerPixel);
  for (SubjectSummary &subject : summary.subjects)
    for (const Measurement &measurement : study.measurements)
      if (measurement.configuration == subject.name && measurement.samplesPerPixel == common &&
          measurement.run == 0)
        subject.commonPicture = measurement.pictureHash;
}

/// One sentence for all subjects with a bent line.
void describeBends(const Summary &summary, const char *over, LineFit SubjectSummary::*line,
                   std::vector<std::string> &problems) {
  std::string names;
  std::size_t count = 0;
  double largest = 0;
  for (const SubjectSummary &subject : summary.subjects)
    if ((subject.*line).bends()) {
      names += (names.empty() ? "" : ", ") + subject.name;
      largest = std::max(largest, std::pow(10, (subject.*line).largestResidual) - 1);
      ++count;
    }
  if (count != 0)
    problems.push_back(fmt::format(
        "relMSE over {} does not follow a straight line ({}; the points deviate by up to {:.2g} "
        "%): the slope is a mean of "
        "several, and that of the last {} numbers of samples is given as well",
        over, count == summary.subjects.size() && count > 1 ? "in all configurations" : names,
        100 * largest, lastLevels));
}

/// Remarks on configurations: one line for all with the same remark.
class Remarks {
public:
  void add(const std::string &name, std::string text) {
    const auto known = std::find_if(remarks.begin(), remarks.end(),
                                    [&](const Remark &remark) { return remark.text == text; });
    if (known == remarks.end())
      remarks.push_back({std::move(text), {name}});
    else
      known->names.push_back(name);
  }
  void list(std::size_t configurations, std::vector<std::string> &problems) const {
    for (const Remark &remark : remarks)
      problems.push_back(remark.names.size() == configurations && configurations > 1
                             ? "all configurations: " + remark.text
                             : fmt::format("{}: {}", fmt::join(remark.names, ", "), remark.text));
  }

private:
  struct Remark {
    std::string text;
    std::vector<std::string> names;
  };
  std::vector<Remark> remarks;
};

void remark(const SubjectSummary &subject, const Summary &summary, const Reference &reference,
            Remarks &remarks) {
  if (subject.nanPixels || subject.infinitePixels)
    remarks.add(subject.name,
                fmt::format("{} pixels were not a number and {} infinite, over all pictures",
                            subject.nanPixels, subject.infinitePixels));
  if (subject.samplesNotFinite)
    remarks.add(subject.name, fmt::format("{} samples were not finite and are left out of the "
                                          "means of their pixels",
                                          subject.samplesNotFinite));
  if (subject.raysTooDeep)
    remarks.add(subject.name,
                fmt::format("{} rays were deeper than the depth limit and saw nothing; the "
                            "reference has the same limit, so no error shows that",
                            subject.raysTooDeep));
  const std::vector<LevelSummary> &levels = subject.levels;
  if (!levels.empty() && std::all_of(levels.begin(), levels.end(), [](const LevelSummary &level) {
        return level.runs > 1 && level.variance == 0;
      }))
    remarks.add(subject.name, "all runs gave the same picture (zero variance), so its efficiency "
                              "is undefined");
  if (!subject.noFit.empty() && summary.heavyTails.empty())
    remarks.add(subject.name, "no line was fitted: " + subject.noFit);
  const auto unresolved = std::count_if(
      levels.begin(), levels.end(), [](const LevelSummary &level) { return !level.isResolved; });
  if (unresolved && reference.ownError)
    remarks.add(
        subject.name,
        fmt::format("the reference's own error is more than a tenth of the error with {}, "
                    "which the line leaves out; a larger `--budget` makes a better reference",
                    unresolved == 1
                        ? std::string("the most samples")
                        : fmt::format("the {} largest numbers of samples", unresolved)));
}

void findProblems(Summary &summary, const Reference &reference) {
  std::vector<std::string> &problems = summary.problems;
  if (!reference.problem.empty())
    problems.push_back(reference.problem);
  else if (std::all_of(reference.image.pixels.begin(), reference.image.pixels.end(),
                       [](float value) { return value == 0; }))
    problems.push_back("the reference is black: relMSE is the squared error over a constant here, "
                       "and FLIP has no exposure");
  if (std::any_of(reference.image.pixels.begin(), reference.image.pixels.end(),
                  [](float v) { return !std::isfinite(v); }) &&
      reference.problem.empty())
    problems.push_back(
        "some pixels of the reference are not finite; they are left out of every error");
  if (!summary.heavyTails.empty())
    problems.push_back(
        "rare, large samples dominate the errors, so that no interval can be given and "
        "no line is fitted (" +
        summary.heavyTails + "); sample bright regions more often, or clamp them");
  if (const double beyond =
          reference.problem.empty() ? shareBeyondScreen(runtime::toRgb(reference.image)) : 0;
      beyond > 0.25)
    problems.push_back(
        fmt::format("{:.0f} % of the reference's pixels are brighter than a screen: FLIP takes "
                    "them as white and measures no error there, HDR-FLIP does",
                    100 * beyond));
  Remarks remarks;
  for (const SubjectSummary &subject : summary.subjects)
    remark(subject, summary, reference, remarks);
  remarks.list(summary.subjects.size(), problems);
  describeBends(summary, "seconds", &SubjectSummary::relMseOverSeconds, problems);
  describeBends(summary, "samples", &SubjectSummary::relMseOverSamples, problems);
}

} // namespace

Summary summarise(const std::vector<Subject> &subjects, const Study &study,
                  const Reference &reference) {
  Summary summary;
  std::vector<ByLevel> byLevel(subjects.size());
  for (std::size_t i = 0; i < subjects.size(); ++i)
    summary.subjects.push_back(summariseSubject(subjects[i], study, reference, byLevel[i]));
  summary.heavyTails = findHeavyTails(study, reference);
  if (!reference.problem.empty()) {
    for (SubjectSummary &subject : summary.subjects)
      subject.noFit = "no errors were measured";
  } else if (!summary.heavyTails.empty()) {
    dropIntervals(summary);
  } else {
    std::vector<Rounds> rounds;
    for (std::size_t i = 0; i < subjects.size(); ++i) {
      rounds.push_back(roundsOf(summary.subjects[i], byLevel[i], reference));
      fitLines(summary.subjects[i], rounds[i]);
      if (i > 0)
        compareWithFirst(rounds.front(), rounds[i], summary.subjects[i]);
    }
    findTimes(summary, rounds);
  }
  comparePictures(summary, study);
  findProblems(summary, reference);
  return summary;
}

} // namespace rtsl::report
