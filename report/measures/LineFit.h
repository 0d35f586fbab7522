//===- LineFit.h - a line through measurements, with its uncertainty ------===//
//
// Measurements are made in rounds: in each round one at every level. A temporary disturbance of a
// machine (another process, heat, a changing clock) affects the neighbouring measurements of a
// round alike, so that these are not independent. All intervals here are computed from the
// differences between rounds only.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

namespace rtsl::report {

/// A value with its 95 % confidence interval.
struct Estimate {
  double value = 0, low = 0, high = 0;
};

/// Measurements: x[level][round] and y[level][round]. `effort` is the quantity that the levels
/// vary, such as the logarithm of a number of samples; it has no error, and ascends.
struct Rounds {
  std::vector<double> effort;
  std::vector<std::vector<double>> x, y;

  std::size_t levels() const { return effort.size(); }
  std::size_t rounds() const { return x.empty() ? 0 : x.front().size(); }
  /// Only levels [first, end).
  Rounds part(std::size_t first, std::size_t end) const;
};

/// y = intercept + slope x.
struct LineFit {
  std::size_t points = 0, rounds = 0;
  double intercept = 0;
  Estimate slope;

  /// The probability of a deviation of the levels' means from a straight line of at least this
  /// size, if the truth is a line. 1: it cannot be tested.
  double lackOfFit = 1;
  double largestResidual = 0; // of a level's mean, in y
  bool bends() const { return points != 0 && lackOfFit < 0.01; }

  double meanX = 0;
  double quantile = 0; // of Student's t with rounds - 1 degrees, at 97.5 %
  double varianceAtMean = 0, varianceOfSlope = 0,
         covariance = 0; // of the line at meanX, and of its slope

  /// The line at x with its confidence band.
  Estimate at(double x) const;
};

/// Fits a line to at least two levels and two rounds; otherwise `points` is 0 and nothing else is
/// set.
///
/// The slope is that of y over `effort` divided by that of x over `effort`: noise of x would
/// flatten the slope of a least-squares fit of y over x (W. A. Fuller, "Measurement Error Models",
/// 1987, section 1.4). Its interval is that of a ratio of means over rounds (W. G. Cochran,
/// "Sampling Techniques", 3rd ed. 1977, section 6.4), with Student's t. `lackOfFit` tests the
/// quadratic and, of four levels, the cubic part of the residuals, each by Student's t over rounds,
/// together by Bonferroni's inequality.
LineFit fitLine(const Rounds &rounds);

/// The x at which y falls to a value, by linear interpolation between the two levels around it.
struct Crossing {
  /// One value per round. Their mean is the crossing of the means, and their spread its uncertainty
  /// (to first order).
  std::vector<double> perRound;
  /// Already the first level is below the value: the true x may be smaller.
  bool isBound = false;

  Estimate estimate() const;
};

/// The first crossing; nothing if no level's mean falls to the value.
std::optional<Crossing> findCrossing(const Rounds &rounds, double y);

/// The mean of values with its confidence interval by Student's t; for one value the interval has
/// width 0.
Estimate meanOf(const std::vector<double> &values);

/// The median of values with its distribution-free interval: order statistics by the binomial
/// distribution. With fewer than six values the interval is their range.
Estimate medianOf(std::vector<double> values);

} // namespace rtsl::report
