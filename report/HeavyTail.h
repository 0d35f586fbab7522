//===- HeavyTail.h - samples that are rare and large ----------------------===//
//
// A sample that is met once in a million and is a million times as bright as the others rules the
// error of a picture, and where few pixels have met one, the spread of independent runs says little
// of how wrong their mean is. No interval can be given then. This finds out from the runs whether
// that is so; what none of them has met, it cannot see.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "report/RunningVariance.h"

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace rtsl::report {

struct TailEvidence {
  std::uint32_t runs = 0;
  /// How much of the squared deviations of a value over the runs its farthest run has alone: the
  /// mean over values, each with the weight of its variance. As runs are added this goes to 0 if
  /// and only if the variance is finite (P. Embrechts, C. Klueppelberg, T. Mikosch, "Modelling
  /// Extremal Events", 1997, section 6.2.6).
  double maximumShare = 0;
  /// A normal distribution exceeds this share in one value of a thousand (F. E. Grubbs, "Procedures
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

/// Needs at least three runs to find anything, and about sixteen to be of use.
TailEvidence findTail(const RunningVariance &runs);

/// TailEvidence::normalShare for a number of runs.
double normalMaximumShare(std::size_t runs);

/// Hill's estimate from the `count` largest of positive values; infinite if there are not as many.
double hillIndex(std::vector<double> values, std::size_t count);

} // namespace rtsl::report
