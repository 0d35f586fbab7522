//===- Summary.h - what a study says --------------------------------------===//
#pragma once

#include "report/LineFit.h"
#include "report/Study.h"

#include <string>
#include <vector>

namespace rtsl::report {

/// All runs of a subject with one number of samples.
struct LevelSummary {
  std::uint32_t samplesPerPixel = 0;
  std::size_t runs = 0;
  Estimate seconds; // of rendering a picture: median and interval
  Estimate rmse, relMse, flip, flipHdr;
  double variance = 0, efficiency = 0;
  /// Whether the reference is good enough to tell: its own relMSE is below a tenth of this one.
  bool isResolved = true;
};

struct SubjectSummary {
  std::string name;
  std::vector<std::pair<std::string, std::string>> settings;
  double compileSeconds = 0;
  Estimate buildSeconds;
  std::vector<LevelSummary> levels;
  LineFit relMseOverSeconds; // log10 of both, one point a run, resolved levels
  LineFit relMseOverSamples;
  std::uint64_t nanPixels = 0, infinitePixels = 0, samplesNotFinite = 0; // over all pictures
  std::string noFit;                                                    // why there is no line, if there is none
  /// The median of the levels' 1 / (variance x seconds), of those with at least 10 ms a picture if there are such.
  double efficiency = 0;
  /// The hash of its picture with the most samples that all subjects have; the same for the same bits.
  std::uint64_t commonPicture = 0;

  /// Seconds until the line reaches an error; not finite without a line.
  double secondsTo(double relMse) const;
};

struct Summary {
  std::vector<SubjectSummary> subjects;
  double commonRelMse = 0;           // an error that every subject with a line came below; 0: there is none
  std::vector<std::string> problems; // what a reader has to know before he trusts a figure
};

Summary summarise(const std::vector<Subject> &subjects, const Study &study, const Reference &reference);

} // namespace rtsl::report
