//===- Summary.h - what a study says --------------------------------------===//
#pragma once

#include "report/LineFit.h"
#include "report/Study.h"

#include <optional>
#include <string>
#include <vector>

namespace rtsl::report {

/// All runs of a subject with one number of samples. Where no interval can be given its ends are
/// not numbers.
struct LevelSummary {
  std::uint32_t samplesPerPixel = 0;
  std::size_t runs = 0;
  Estimate seconds; // of rendering a picture: median and interval
  Estimate rmse, relMse, flip, flipHdr;
  double variance = 0, efficiency = 0;
  /// Whether the reference is good enough to tell: its own relMSE is below a tenth of this one.
  bool isResolved = true;
  /// How many times as long as the first subject this one takes to the error that it has at this
  /// level, paired by rounds. Nothing where the first was not measured on both sides of that error,
  /// and for the first itself.
  std::optional<Estimate> timesTheFirst;
};

/// When a subject came to an error.
struct TimeToError {
  Estimate seconds;
  bool isBound = false; // it may be sooner: its first pictures were better already
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
  /// The slopes of the last three levels that the lines use, where there are more and a line bends.
  std::optional<Estimate> lastSlopeOverSeconds, lastSlopeOverSamples;
  std::uint64_t nanPixels = 0, infinitePixels = 0, samplesNotFinite = 0,
                raysTooDeep = 0; // over all pictures
  std::string noFit;             // why there is no line, if there is none
  /// The median of the levels' 1 / (variance x seconds), of those with at least 10 ms a picture if
  /// there are such.
  double efficiency = 0;
  /// The hash of its picture with the most samples that all subjects have; the same for the same
  /// bits.
  std::uint64_t commonPicture = 0;
  /// Of Summary::commonRelMse, read off the measured points on both sides.
  std::optional<TimeToError> toCommonRelMse;
  /// That time in times of the quickest subject's, paired by rounds.
  std::optional<Estimate> timesTheQuickest;
};

struct Summary {
  std::vector<SubjectSummary> subjects;
  double commonRelMse = 0; // an error that every subject with a line came down to; 0: there is none
  /// Why no interval of an error can be given: rare, large samples. Empty if it can.
  std::string heavyTails;
  std::vector<std::string> problems; // what a reader has to know before he trusts a figure
};

Summary summarise(const std::vector<Subject> &subjects, const Study &study,
                  const Reference &reference);

} // namespace rtsl::report
