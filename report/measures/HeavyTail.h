//===- HeavyTail.h - rare and large samples -------------------------------===//
//
// A sample that occurs once in a million and is a million times as bright as the others dominates
// the error of a picture. If few pixels have such a sample, the spread of independent runs shows
// little about the error of their mean, and no interval can be given. This is detected from the
// runs; a sample that none of them has is not detected.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "report/measures/RunningVariance.h"

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace rtsl::report {

struct TailEvidence {
  std::uint32_t runs = 0;
  /// The share of the squared deviations of a value over the runs that is due to its farthest run:
  /// the mean over values, weighted by their variance. As runs are added this goes to 0 if and only
  /// if the variance is finite (P. Embrechts, C. Klueppelberg, T. Mikosch, "Modelling Extremal
  /// Events", 1997, section 6.2.6).
  double maximumShare = 0;
  /// A normal distribution exceeds this share for one value in a thousand (F. E. Grubbs,
  /// "Procedures
  /// for Detecting Outlying Observations in Samples", 1969).
  double normalShare = 1;
  /// The index of the tail of the largest relative deviations (B. M. Hill, "A simple general
  /// approach to inference about the tail of a distribution", 1975), with twice its standard error
  /// added. Below 2 there is no variance.
  double tailIndex = std::numeric_limits<double>::infinity();

  bool isHeavy() const;
  /// "one of 32 runs has 93 % of the spread of a typical pixel, ...".
  std::string text() const;
};

/// Requires at least three runs, and about sixteen for a useful result.
TailEvidence findTail(const RunningVariance &runs);

/// TailEvidence::normalShare for a number of runs.
double normalMaximumShare(std::size_t runs);

/// Hill's estimate from the `count` largest of positive values; infinite if there are fewer.
double hillIndex(std::vector<double> values, std::size_t count);

} // namespace rtsl::report
