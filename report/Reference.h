//===- Reference.h - what the pictures of a study are compared with -------===//
#pragma once

#include "report/HeavyTail.h"
#include "report/Subject.h"

#include <optional>
#include <string>

namespace rtsl::report {

struct Reference {
  runtime::Image image;
  std::string origin; // for people: where it comes from
  /// How wrong the reference itself is, if it was rendered here.
  struct OwnError {
    double rmse = 0, relMse = 0; // the standard error of its mean; not a number if `tail` is heavy
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

/// Reads a picture; one that is not finite anywhere or of another shape than `width` x `height` x
/// `channels` is no error but a `problem`. Throws as readImage.
Reference readReference(const std::string &path, std::uint32_t width, std::uint32_t height,
                        std::uint32_t channels);

/// The reference that makeReference left in `folder`, rendered by the subject of that name; nothing
/// if there is none.
std::optional<Reference> findReference(const std::string &subject, const std::string &folder);

/// Renders one as the mean of up to `runs` independent runs that take about `seconds` together, and
/// leaves it in `folder`. Of pictures that take longer there are fewer runs, but at least
/// `fewestRuns`. Its own error is estimated from the spread of the runs, unless they have heavy
/// tails, and what rounding does from one run of `single`, which renders the same with less
/// precision.
constexpr std::uint32_t fewestRuns = 8;
Reference makeReference(const Subject &subject, const Subject &single, const std::string &folder,
                        std::uint32_t runs, double seconds, const ProgressFunction &progress);

} // namespace rtsl::report
