//===- LineFit.h - a straight line through measurements, and how sure it is ===//
#pragma once

#include <cstddef>
#include <vector>

namespace rtsl::report {

/// A value and how far it may be off, with 95 % confidence.
struct Estimate {
  double value = 0, low = 0, high = 0;
};

/// y = intercept + slope x by least squares, for errors of y that are independent and of one size.
struct LineFit {
  std::size_t points = 0;
  double intercept = 0;
  Estimate slope;

  double meanX = 0, sumOfSquaresX = 0; // sum of (x - meanX)^2
  double deviation = 0;                // of y about the line
  double quantile = 0;                 // of Student's t with points - 2 degrees, at 97.5 %

  /// The line at x with its confidence band.
  Estimate at(double x) const;
};

/// Wants at least three points at two different x; otherwise `points` is 0 and nothing else is set. The confidence
/// interval: N. R. Draper, H. Smith, "Applied Regression Analysis", 3rd ed. 1998, section 1.4.
LineFit fitLine(const std::vector<double> &x, const std::vector<double> &y);

/// The mean of values with its confidence interval by Student's t; one value has an interval of no width.
Estimate meanOf(const std::vector<double> &values);

/// The median of values with its distribution-free interval: order statistics by the binomial distribution. With fewer
/// than six values the interval is their range.
Estimate medianOf(std::vector<double> values);

} // namespace rtsl::report
