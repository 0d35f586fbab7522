//===- Reference.h - the reference of a study -----------------------------===//
#pragma once

#include "report/Subject.h"
#include "report/measures/HeavyTail.h"

#include <optional>
#include <string>

namespace rtsl::report {

struct Reference {
  runtime::Image image;
  std::string origin; // for people: where it comes from
  /// The error of the reference itself, if it was rendered here.
  struct OwnError {
    double rmse = 0, relMse = 0; // the standard error of its mean; NaN if `tail` is heavy
    TailEvidence tail;
    double rounding =
        0; // RMSE of a run in single precision from the run in double with the same samples
    std::uint32_t runs = 0, samplesPerPixel = 0; // of each run
    double seconds = 0;
  };
  std::optional<OwnError> ownError;
  /// Why errors cannot be measured against it; empty if they can.
  std::string problem;
};

/// Reads a picture; one without finite pixels or of another shape than `width` x `height` x
/// `channels` gives a `problem`, not an exception. Throws like readImage.
Reference readReference(const std::string &path, std::uint32_t width, std::uint32_t height,
                        std::uint32_t channels);

/// The reference that makeReference wrote to `folder`, rendered by the subject of that name;
/// nothing if there is none.
std::optional<Reference> findReference(const std::string &subject, const std::string &folder);

/// Renders one as the mean of up to `runs` independent runs that take about `seconds` together, and
/// writes it to `folder`. If pictures take longer there are fewer runs, but at least `fewestRuns`.
/// Its own error is estimated from the spread of the runs, unless they have heavy tails, and the
/// effect of rounding from one run of `single`, which renders the same with less precision.
constexpr std::uint32_t fewestRuns = 8;
Reference makeReference(const Subject &subject, const Subject &single, const std::string &folder,
                        std::uint32_t runs, double seconds, const ProgressFunction &progress);

} // namespace rtsl::report
