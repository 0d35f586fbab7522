//===- Study.cpp ----------------------------------------------------------===//
#include "report/Study.h"

#include "report/measures/ErrorMetrics.h"
#include "report/measures/Flip.h"
#include "report/measures/RunningVariance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <numeric>
#include <random>
#include <set>
#include <tuple>

namespace rtsl::report {

namespace {

constexpr unsigned levelsInAnyCase = 3; // required for a line

class StudyRun {
public:
  StudyRun(const std::vector<Subject> &subjects, const Reference &reference,
           const StudyOptions &options)
      : subjects(subjects), reference(reference), options(options), state(subjects.size()) {
    std::filesystem::create_directories(options.folder + "/partial");
    std::filesystem::create_directories(options.folder + "/pictures");
    study.measurements = readMeasurements(tablePath());
    for (const Measurement &measurement : study.measurements)
      known[keyOf(measurement.configuration, measurement.samplesPerPixel, measurement.run)] =
          measurement;
    if (reference.problem.empty()) {
      screen = runtime::toRgb(reference.image);
      exposures = exposuresFor(screen);
    }
  }

  Study run() {
    measureFirstRound();
    for (std::uint32_t round = 1; round < options.runs; ++round)
      measureRound(round);
    summariseLevels();
    std::filesystem::remove_all(options.folder + "/partial");
    return std::move(study);
  }

private:
  using Key = std::tuple<std::string, std::uint32_t, std::uint32_t>; // configuration, samples, run

  /// The state of a subject.
  struct State {
    unsigned levels = 0;           // that fit into its budget
    double spent = 0, inRound = 0; // seconds of rendering: in all, and in the first round
    bool isWarm = false;
  };

  const std::vector<Subject> &subjects;
  const Reference &reference;
  const StudyOptions &options;
  Study study;
  std::map<Key, Measurement> known;
  runtime::Image screen; // the reference in RGB
  FlipExposures exposures;
  std::vector<State> state;
  /// For subjects with the same number of samples in one round: strict configurations all give the
  /// same pictures.
  std::map<std::uint64_t, Measurement> errorsOfPictures;
  std::map<std::pair<std::uint64_t, std::uint64_t>, double> variancesOfPairs;
  bool measuredInRound = false;

  static Key keyOf(const std::string &configuration, std::uint32_t samples, std::uint32_t run) {
    return {configuration, samples, run};
  }
  std::string tablePath() const { return options.folder + "/measurements.csv"; }
  std::string partialPath(std::uint64_t hash) const {
    return fmt::format("{}/partial/{:016x}.exr", options.folder, hash);
  }
  std::uint32_t seedOf(unsigned level, std::uint32_t run) const {
    return 1 + level * options.runs + run;
  }

  void measureFirstRound() {
    measuredInRound = false;
    for (unsigned level = 0; level < 32 && (1u << level) <= options.mostSamples; ++level) {
      std::vector<std::size_t> running;
      for (std::size_t subject = 0; subject < subjects.size(); ++subject)
        if (state[subject].levels == level && hasTimeFor(subject, level))
          running.push_back(subject);
      if (running.empty())
        break;
      forgetPictures();
      for (std::size_t subject : running) {
        const double seconds = measure(subject, level, 0);
        state[subject].inRound += seconds;
        state[subject].levels = level + 1;
      }
    }
    dropPicturesBefore(0);
  }

  void measureRound(std::uint32_t round) {
    measuredInRound = false;
    unsigned levels = 0;
    for (const State &one : state)
      levels = std::max(levels, one.levels);
    for (unsigned level : levelOrder(round, levels)) {
      forgetPictures();
      for (std::size_t turn = 0; turn < subjects.size(); ++turn) {
        const std::size_t subject = (turn + round) % subjects.size();
        if (level < state[subject].levels)
          measure(subject, level, round);
      }
    }
    dropPicturesBefore(round);
  }

  /// Whether the next level, which takes twice as long as the last, fits into the remaining time of
  /// a subject, over all rounds.
  bool hasTimeFor(std::size_t subject, unsigned level) const {
    if (level < levelsInAnyCase)
      return true;
    const Measurement &last = known.at(keyOf(subjects[subject].name, 1u << (level - 1), 0));
    return (state[subject].inRound + 2 * last.renderSeconds) * options.runs <=
           options.budgetSeconds;
  }

  double share() const {
    double sum = 0;
    for (const State &one : state) {
      const bool isFirst = one.spent <= one.inRound;
      const double expected = isFirst ? options.budgetSeconds : one.inRound * options.runs;
      sum += expected > 0 ? std::min(one.spent / expected, 1.0) : 0.0;
    }
    return sum / double(subjects.size());
  }

  void forgetPictures() {
    errorsOfPictures.clear();
    variancesOfPairs.clear();
  }

  /// Renders a picture and records its errors, unless they are known. Returns the seconds that it
  /// took.
  double measure(std::size_t index, unsigned level, std::uint32_t run) {
    const Subject &subject = subjects[index];
    const std::uint32_t samples = 1u << level;
    options.progress(share(), fmt::format("{}, {} spp, run {}", subject.name, samples, run + 1));
    const Key key = keyOf(subject.name, samples, run);
    if (const auto earlier = known.find(key); earlier != known.end()) {
      state[index].spent += earlier->second.renderSeconds;
      return earlier->second.renderSeconds;
    }
    if (!state[index].isWarm) { // the first picture warms up memory and caches
      subject.render(1, seedOf(level, run));
      state[index].isWarm = true;
    }
    measuredInRound = true;
    const Picture picture = subject.render(samples, seedOf(level, run));
    Measurement measurement = errorsOf(picture.image);
    measurement.configuration = subject.name;
    measurement.samplesPerPixel = samples;
    measurement.run = run;
    measurement.seed = seedOf(level, run);
    measurement.buildSeconds = picture.statistics.buildSeconds;
    measurement.renderSeconds = picture.statistics.renderSeconds;
    measurement.samplesNotFinite = picture.statistics.samplesNotFinite;
    measurement.raysTooDeep = picture.statistics.raysTooDeep;
    if (run > 0)
      measurement.pairVariance =
          varianceOfPair(subject, level, run, measurement.pictureHash, picture.image);
    if (const std::string path = partialPath(measurement.pictureHash);
        !std::filesystem::exists(path))
      runtime::writeImage(path, picture.image);
    if (run == 0)
      runtime::writeImage(lastPicturePath(options.folder, subject), picture.image);
    appendMeasurement(tablePath(), measurement); // after the picture, which the next round needs
    state[index].spent += measurement.renderSeconds;
    study.measurements.push_back(measurement);
    return known.emplace(key, std::move(measurement)).first->second.renderSeconds;
  }

  /// Of this picture and that of the previous run, which has another seed.
  double varianceOfPair(const Subject &subject, unsigned level, std::uint32_t run,
                        std::uint64_t hash, const runtime::Image &image) {
    const std::uint64_t before = known.at(keyOf(subject.name, 1u << level, run - 1)).pictureHash;
    const auto [found, isNew] = variancesOfPairs.try_emplace({before, hash}, 0.0);
    if (isNew) {
      const std::string path =
          partialPath(before); // missing if the study was interrupted in between
      RunningVariance pair;
      pair.add(std::filesystem::exists(path)
                   ? runtime::readImage(path)
                   : subject.render(1u << level, seedOf(level, run - 1)).image);
      pair.add(image);
      found->second = pair.meanVariance();
    }
    return found->second;
  }

  /// Deletes the pictures of earlier rounds. Those of this round are compared with the next one's.
  /// After a round that an earlier study made nothing is deleted: the pictures there belong to the
  /// round in which it was interrupted.
  void dropPicturesBefore(std::uint32_t round) {
    if (!measuredInRound)
      return;
    std::set<std::string> wanted;
    for (const auto &[key, measurement] : known)
      if (measurement.run == round)
        wanted.insert(partialPath(measurement.pictureHash));
    std::vector<std::filesystem::path> old;
    for (const auto &entry : std::filesystem::directory_iterator(options.folder + "/partial"))
      if (!wanted.count(entry.path().string()))
        old.push_back(entry.path());
    for (const std::filesystem::path &path : old)
      std::filesystem::remove(path);
  }

  Measurement errorsOf(const runtime::Image &image) {
    const std::uint64_t hash = hashOf(image.pixels);
    const auto [known, isNew] = errorsOfPictures.try_emplace(hash);
    if (!isNew)
      return known->second;
    Measurement &measurement = known->second;
    measurement.pictureHash = hash;
    // A picture without a reference is compared with itself, which counts values that are not
    // finite.
    const ErrorMetrics error =
        measureError(reference.problem.empty() ? reference.image : image, image);
    measurement.nanPixels = error.nanPixels;
    measurement.infinitePixels = error.infinitePixels;
    if (!reference.problem.empty() || error.pixels == 0) {
      measurement.rmse = measurement.relMse = measurement.bias = measurement.flip =
          measurement.flipHdr = std::numeric_limits<double>::quiet_NaN();
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

  void summariseLevels() {
    for (std::size_t index = 0; index < subjects.size(); ++index)
      for (unsigned level = 0; level < state[index].levels; ++level) {
        LevelVariance result;
        result.configuration = subjects[index].name;
        result.samplesPerPixel = 1u << level;
        for (std::uint32_t run = 0; run < options.runs; ++run) {
          const Measurement &one =
              known.at(keyOf(result.configuration, result.samplesPerPixel, run));
          result.variance += one.pairVariance / (options.runs - 1);
          result.meanSeconds += one.renderSeconds / options.runs;
        }
        result.efficiency = 1 / (result.variance * result.meanSeconds);
        study.levels.push_back(std::move(result));
      }
    writeLevels(options.folder + "/levels.csv", study.levels);
  }
};

} // namespace

std::vector<unsigned> levelOrder(std::uint32_t round, unsigned levels) {
  std::vector<unsigned> order(levels);
  std::iota(order.begin(), order.end(), 0u);
  if (round == 0)
    return order;
  std::mt19937 random(round);
  for (unsigned i = levels; i > 1; --i)
    std::swap(order[i - 1], order[random() % i]);
  return order;
}

std::string lastPicturePath(const std::string &folder, const Subject &subject) {
  std::string file = subject.name;
  std::replace(file.begin(), file.end(), ' ', '-');
  return folder + "/pictures/" + file + ".exr";
}

Study runStudy(const std::vector<Subject> &subjects, const Reference &reference,
               const StudyOptions &options) {
  return StudyRun(subjects, reference, options).run();
}

} // namespace rtsl::report
