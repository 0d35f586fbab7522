//===- RunningVariance.h - mean and variance of a picture over runs -------===//
#pragma once

#include "runtime/image/Image.h"

#include <functional>
#include <vector>

namespace rtsl::report {

/// The mean and the unbiased sample variance of each value over pictures of one shape, by Welford's
/// update (B. P. Welford, "Note on a method for calculating corrected sums of squares and
/// products", 1962), which does not cancel. Values that are not finite are left out.
class RunningVariance {
public:
  void add(const runtime::Image &picture);

  std::size_t pictures() const { return count; }
  /// NaN where no picture has a finite value.
  runtime::Image mean() const;
  /// Over all values; 0 with fewer than two pictures.
  double meanVariance() const;
  /// Of variance / (mean^2 + epsilon) over all values.
  double meanRelativeVariance(double epsilon) const;
  /// Calls `visit` with the mean of each value that is finite in some picture, its sum of squared
  /// deviations, and the largest deviation of a picture.
  void forEachValue(
      const std::function<void(double mean, double squares, double deviation)> &visit) const;

private:
  /// The mean of `weight(i)` times the variance of value i, over those with two pictures or more.
  template <typename Weight>
  double meanOf(Weight weight) const;

  std::size_t count = 0;
  runtime::Image shape;              // of the first picture, without its values
  std::vector<std::uint32_t> counts; // pictures in which the value is finite
  std::vector<double> means, squares;
  std::vector<float> smallest, largest;
};

} // namespace rtsl::report
