//===- Reference.cpp ------------------------------------------------------===//
#include "report/Reference.h"

#include "report/measures/ErrorMetrics.h"
#include "report/measures/RunningVariance.h"
#include "support/AtomicFile.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <unistd.h>

namespace rtsl::report {

namespace {

constexpr std::uint32_t firstSeed = 1u << 24; // far from those of a study
constexpr std::uint32_t mostSamples = 1u << 20;

std::string picturePath(const std::string &folder) {
  return folder + "/reference.exr";
}
std::string factsPath(const std::string &folder) {
  return folder + "/reference.json";
}

std::string describe(const std::string &subject, const Reference::OwnError &own) {
  const std::string error =
      own.tail.isHeavy()
          ? "its error cannot be estimated, because rare, large samples dominate it (" +
                own.tail.text() + ")"
          : fmt::format("its own RMSE is about {:.2g}, its relMSE {:.2g}", own.rmse, own.relMse);
  return fmt::format("the mean of {} runs with {} samples a pixel ({}), in {:.3g} s; {}; single "
                     "precision changes a run by {:.2g} (RMSE)",
                     own.runs, own.samplesPerPixel, subject, own.seconds, error, own.rounding);
}

/// JSON has neither infinity nor NaN.
double numberOr(const nlohmann::json &facts, const char *key, double otherwise) {
  const auto found = facts.find(key);
  return found != facts.end() && found->is_number() ? found->get<double>() : otherwise;
}

constexpr int factsVersion = 2;

/// Samples per pixel for a run of about `seconds`, estimated from shorter runs.
std::uint32_t samplesFor(const Subject &subject, double seconds) {
  std::uint32_t samples = 1;
  for (;;) {
    const double taken =
        std::max(subject.render(samples, firstSeed - 1).statistics.renderSeconds, 1e-6);
    const double possible = samples * seconds / taken;
    if (possible < 8.0 * samples || samples >= mostSamples / 8) // long enough for an estimate
      return std::uint32_t(std::clamp(possible, 1.0, double(mostSamples)));
    samples *= 8;
  }
}

} // namespace

Reference readReference(const std::string &path, std::uint32_t width, std::uint32_t height,
                        std::uint32_t channels) {
  Reference reference;
  reference.image = runtime::readImage(path);
  reference.origin = path;
  const runtime::Image &image = reference.image;
  if (image.width != width || image.height != height || image.channels != channels)
    reference.problem = fmt::format(
        "`{}` has {}x{} pixels of {} channels, the pictures {}x{} of {}: no errors are measured",
        path, image.width, image.height, image.channels, width, height, channels);
  else if (std::none_of(image.pixels.begin(), image.pixels.end(),
                        [](float value) { return std::isfinite(value); }))
    reference.problem = fmt::format("`{}` has no finite pixel: no errors are measured", path);
  return reference;
}

std::optional<Reference> findReference(const std::string &subject, const std::string &folder) {
  if (::access(picturePath(folder).c_str(), R_OK) != 0 ||
      ::access(factsPath(folder).c_str(), R_OK) != 0)
    return std::nullopt;
  const nlohmann::json facts = nlohmann::json::parse(readFile(factsPath(folder)), nullptr, false);
  if (facts.is_discarded() || facts.value("version", 0) != factsVersion ||
      facts.value("subject", "") != subject)
    return std::nullopt;
  Reference reference;
  reference.image = runtime::readImage(picturePath(folder));
  Reference::OwnError own;
  own.rmse = numberOr(facts, "rmse", std::numeric_limits<double>::quiet_NaN());
  own.relMse = numberOr(facts, "relMse", std::numeric_limits<double>::quiet_NaN());
  own.rounding = numberOr(facts, "rounding", 0);
  own.runs = facts.value("runs", 0u);
  own.samplesPerPixel = facts.value("spp", 0u);
  own.seconds = numberOr(facts, "seconds", 0);
  own.tail.runs = own.runs;
  own.tail.maximumShare = numberOr(facts, "maximumShare", 0);
  own.tail.normalShare = normalMaximumShare(own.runs);
  own.tail.tailIndex = numberOr(facts, "tailIndex", std::numeric_limits<double>::infinity());
  reference.ownError = own;
  reference.origin = describe(subject, *reference.ownError);
  return reference;
}

Reference makeReference(const Subject &subject, const Subject &single, const std::string &folder,
                        std::uint32_t runs, double seconds, const ProgressFunction &progress) {
  Reference::OwnError own;
  own.samplesPerPixel = samplesFor(subject, seconds / runs);
  RunningVariance spread;
  while (own.runs < runs && (own.runs < fewestRuns || own.seconds < seconds)) {
    progress(double(own.runs) / runs, "rendering the reference");
    const Picture picture = subject.render(own.samplesPerPixel, firstSeed + own.runs);
    own.seconds += picture.statistics.renderSeconds;
    if (own.runs == 0)
      own.rounding =
          measureError(picture.image, single.render(own.samplesPerPixel, firstSeed).image).rmse;
    spread.add(picture.image);
    ++own.runs;
  }
  Reference reference;
  reference.image = spread.mean();
  own.tail = findTail(spread);
  const bool isKnown = !own.tail.isHeavy();
  own.rmse = isKnown ? std::sqrt(spread.meanVariance() / own.runs)
                     : std::numeric_limits<double>::quiet_NaN();
  own.relMse = isKnown ? spread.meanRelativeVariance(relMseEpsilon) / own.runs
                       : std::numeric_limits<double>::quiet_NaN();
  reference.ownError = own;
  reference.origin = describe(subject.name, own);
  runtime::writeImage(picturePath(folder), reference.image);
  const nlohmann::ordered_json facts = {{"version", factsVersion},
                                        {"subject", subject.name},
                                        {"runs", own.runs},
                                        {"spp", own.samplesPerPixel},
                                        {"seconds", own.seconds},
                                        {"rmse", own.rmse},
                                        {"relMse", own.relMse},
                                        {"rounding", own.rounding},
                                        {"heavyTails", own.tail.isHeavy()},
                                        {"maximumShare", own.tail.maximumShare},
                                        {"tailIndex", own.tail.tailIndex}};
  writeFileAtomically(factsPath(folder), facts.dump(2) + "\n");
  return reference;
}

} // namespace rtsl::report
