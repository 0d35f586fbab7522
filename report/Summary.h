//===- Summary.h - the results of a study ---------------------------------===//
#pragma once

#include "report/Study.h"
#include "report/measures/LineFit.h"

#include <optional>
#include <string>
#include <vector>

namespace rtsl::report {

/// All runs of a subject with one number of samples. Intervals that cannot be given have NaN ends.
struct LevelSummary {
  std::uint32_t samplesPerPixel = 0;
  std::size_t runs = 0;
  Estimate seconds; // of rendering a picture: median and interval
  Estimate rmse, relMse, flip, flipHdr;
  double variance = 0, efficiency = 0;
  /// Whether the reference is good enough: its own relMSE is below a tenth of this one.
  bool isResolved = true;
  /// The time of this subject, relative to the first, for the error that it has at this level,
  /// paired by rounds. Nothing if the first was not measured on both sides of that error, and for
  /// the first itself.
  std::optional<Estimate> timesTheFirst;
};

/// When a subject reached an error.
struct TimeToError {
  Estimate seconds;
  bool isBound = false; // it may be sooner: its first pictures were already better
};

struct SubjectSummary {
  std::string name;
  std::vector<std::pair<std::string, std::string>> settings;
  double compileSeconds = 0;
  Estimate buildSeconds;
  std::vector<LevelSummary> levels;
  // log10 of both, resolved levels; the reference's own error is subtracted
  LineFit relMseOverSeconds;
  LineFit relMseOverSamples;
  /// The slopes of the last three levels that the lines use, if there are more and a line bends.
  std::optional<Estimate> lastSlopeOverSeconds, lastSlopeOverSamples;
  std::uint64_t nanPixels = 0, infinitePixels = 0, samplesNotFinite = 0,
                raysTooDeep = 0; // over all pictures
  std::string noFit;             // why there is no line; empty if there is one
  /// The median of the levels' 1 / (variance x seconds), of those with at least 10 ms per picture
  /// if there are any.
  double efficiency = 0;
  /// The hash of its picture with the most samples that all subjects have; equal for the same bits.
  std::uint64_t commonPicture = 0;
  /// For Summary::commonRelMse, interpolated between the measured points on both sides.
  std::optional<TimeToError> toCommonRelMse;
  /// That time relative to the quickest subject's, paired by rounds.
  std::optional<Estimate> timesTheQuickest;
};

struct Summary {
  std::vector<SubjectSummary> subjects;
  double commonRelMse = 0; // an error that every subject with a line reached; 0: none
  /// Why no interval of an error can be given: rare, large samples. Empty if it can.
  std::string heavyTails;
  std::vector<std::string> problems; // what limits the reliability of the figures
};

Summary summarise(const std::vector<Subject> &subjects, const Study &study,
                  const Reference &reference);

} // namespace rtsl::report
