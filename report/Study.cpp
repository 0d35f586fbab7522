//===- Study.cpp ----------------------------------------------------------===//
#include "report/Study.h"

#include "report/ErrorMetrics.h"
#include "report/Flip.h"
#include "report/RunningVariance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>

namespace rtsl::report {

namespace {

constexpr unsigned levelsInAnyCase = 3; // a line needs them

class StudyRun {
public:
  StudyRun(const std::vector<Subject> &subjects, const Reference &reference, const StudyOptions &options)
      : subjects(subjects), reference(reference), options(options), spent(subjects.size(), 0.0), level(subjects.size()) {
    std::filesystem::create_directories(options.folder + "/partial");
    std::filesystem::create_directories(options.folder + "/pictures");
    study.measurements = readMeasurements(tablePath());
    study.levels = readLevels(levelsPath());
    if (reference.problem.empty()) {
      screen = runtime::toRgb(reference.image);
      exposures = exposuresFor(screen);
    }
  }

  Study run() {
    unsigned index = 0;
    for (std::uint32_t samples = 1; samples <= options.mostSamples && runLevel(index, samples); ++index)
      samples *= 2;
    std::filesystem::remove_all(options.folder + "/partial");
    return std::move(study);
  }

private:
  const std::vector<Subject> &subjects;
  const Reference &reference;
  const StudyOptions &options;
  Study study;
  runtime::Image screen; // the reference in RGB
  FlipExposures exposures;
  std::vector<double> spent; // seconds of rendering, by subject

  /// What is known of the level that runs, by subject.
  struct Level {
    double seconds = 0;
    RunningVariance spread;
  };
  std::vector<Level> level;
  /// Errors by the bits of the picture: strict configurations all give the same one.
  std::map<std::uint64_t, Measurement> errorsOfPictures;

  std::string tablePath() const { return options.folder + "/measurements.csv"; }
  std::string levelsPath() const { return options.folder + "/levels.csv"; }
  std::string partialPath(std::uint64_t hash) const { return fmt::format("{}/partial/{:016x}.exr", options.folder, hash); }

  /// Whether the next level, which takes twice as long as the last, fits into what is left of a subject's time.
  bool hasTimeFor(std::size_t subject, unsigned index) const {
    return index < levelsInAnyCase || spent[subject] + 2 * level[subject].seconds <= options.budgetSeconds;
  }

  double share() const {
    double sum = 0;
    for (double seconds : spent)
      sum += std::min(seconds / options.budgetSeconds, 1.0);
    return sum / double(subjects.size());
  }

  /// False if no subject has time for it.
  bool runLevel(unsigned index, std::uint32_t samples) {
    std::vector<std::size_t> running;
    for (std::size_t subject = 0; subject < subjects.size(); ++subject)
      if (hasTimeFor(subject, index))
        running.push_back(subject);
    for (std::size_t subject : running)
      level[subject] = {};
    errorsOfPictures.clear();
    for (std::uint32_t run = 0; run < options.runs; ++run)
      for (std::size_t turn = 0; turn < running.size(); ++turn)
        measure(running[(turn + run) % running.size()], samples, run, 1 + index * options.runs + run);
    bool isNew = false;
    for (std::size_t subject : running) {
      spent[subject] += level[subject].seconds;
      isNew |= closeLevel(subject, samples);
    }
    if (isNew) { // otherwise its pictures went long ago, and those of the level that was interrupted are still wanted
      std::filesystem::remove_all(options.folder + "/partial");
      std::filesystem::create_directories(options.folder + "/partial");
    }
    return !running.empty();
  }

  const Measurement *findMeasurement(const Subject &subject, std::uint32_t samples, std::uint32_t run) const {
    for (const Measurement &measurement : study.measurements)
      if (measurement.configuration == subject.name && measurement.samplesPerPixel == samples && measurement.run == run)
        return &measurement;
    return nullptr;
  }

  const LevelVariance *findLevel(const Subject &subject, std::uint32_t samples) const {
    for (const LevelVariance &level : study.levels)
      if (level.configuration == subject.name && level.samplesPerPixel == samples)
        return &level;
    return nullptr;
  }

  void measure(std::size_t index, std::uint32_t samples, std::uint32_t run, std::uint32_t seed) {
    const Subject &subject = subjects[index];
    options.progress(share(), fmt::format("{}, {} spp, run {}", subject.name, samples, run + 1));
    if (const Measurement *earlier = findMeasurement(subject, samples, run)) {
      level[index].seconds += earlier->renderSeconds;
      if (!findLevel(subject, samples)) { // the pictures are still wanted
        const std::string path = partialPath(earlier->pictureHash);
        level[index].spread.add(std::filesystem::exists(path) ? runtime::readImage(path) : subject.render(samples, seed).image);
      }
      return;
    }
    const Picture picture = subject.render(samples, seed);
    Measurement measurement = errorsOf(picture.image);
    measurement.configuration = subject.name;
    measurement.samplesPerPixel = samples;
    measurement.run = run;
    measurement.seed = seed;
    measurement.buildSeconds = picture.statistics.buildSeconds;
    measurement.renderSeconds = picture.statistics.renderSeconds;
    measurement.samplesNotFinite = picture.statistics.samplesNotFinite;
    if (const std::string path = partialPath(measurement.pictureHash); !std::filesystem::exists(path))
      runtime::writeImage(path, picture.image);
    if (run == 0)
      runtime::writeImage(lastPicturePath(options.folder, subject), picture.image);
    appendMeasurement(tablePath(), measurement); // after the picture, which an interrupted study needs
    level[index].seconds += measurement.renderSeconds;
    level[index].spread.add(picture.image);
    study.measurements.push_back(std::move(measurement));
  }

  Measurement errorsOf(const runtime::Image &image) {
    const std::uint64_t hash = hashOf(image.pixels);
    const auto [known, isNew] = errorsOfPictures.try_emplace(hash);
    if (!isNew)
      return known->second;
    Measurement &measurement = known->second;
    measurement.pictureHash = hash;
    // A picture without a reference is compared with itself: that counts what is not finite.
    const ErrorMetrics error = measureError(reference.problem.empty() ? reference.image : image, image);
    measurement.nanPixels = error.nanPixels;
    measurement.infinitePixels = error.infinitePixels;
    if (!reference.problem.empty() || error.pixels == 0) {
      measurement.rmse = measurement.relMse = measurement.bias = measurement.flip = measurement.flipHdr =
          std::numeric_limits<double>::quiet_NaN();
      return measurement;
    }
    measurement.rmse = error.rmse;
    measurement.relMse = error.relMse;
    measurement.bias = error.bias;
    const runtime::Image rgb = runtime::toRgb(image);
    measurement.flip = flip(screen, rgb).mean();
    measurement.flipHdr = flipHdr(screen, rgb, exposures).mean();
    return measurement;
  }

  /// False if an earlier run did.
  bool closeLevel(std::size_t index, std::uint32_t samples) {
    if (findLevel(subjects[index], samples))
      return false;
    LevelVariance result;
    result.configuration = subjects[index].name;
    result.samplesPerPixel = samples;
    result.variance = level[index].spread.meanVariance();
    result.meanSeconds = level[index].seconds / options.runs;
    result.efficiency = 1 / (result.variance * result.meanSeconds);
    appendLevel(levelsPath(), result);
    study.levels.push_back(std::move(result));
    return true;
  }
};

} // namespace

std::string lastPicturePath(const std::string &folder, const Subject &subject) {
  std::string file = subject.name;
  std::replace(file.begin(), file.end(), ' ', '-');
  return folder + "/pictures/" + file + ".exr";
}

Study runStudy(const std::vector<Subject> &subjects, const Reference &reference, const StudyOptions &options) {
  return StudyRun(subjects, reference, options).run();
}

} // namespace rtsl::report
