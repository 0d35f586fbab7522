//===- RunningVariance.cpp ------------------------------------------------===//
#include "report/measures/RunningVariance.h"
#include "support/ErrorMessages.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rtsl::report {

void RunningVariance::add(const runtime::Image &picture) {
  if (count == 0) {
    shape.width = picture.width;
    shape.height = picture.height;
    shape.channels = picture.channels;
    counts.assign(picture.pixels.size(), 0);
    means.assign(picture.pixels.size(), 0.0);
    squares.assign(picture.pixels.size(), 0.0);
    smallest.assign(picture.pixels.size(), std::numeric_limits<float>::infinity());
    largest.assign(picture.pixels.size(), -std::numeric_limits<float>::infinity());
  } else if (picture.pixels.size() != means.size()) {
    throw Error(message::varianceNeedsOneShape());
  }
  ++count;
  for (std::size_t i = 0; i < means.size(); ++i) {
    const float value = picture.pixels[i];
    if (!std::isfinite(value))
      continue;
    smallest[i] = std::min(smallest[i], value);
    largest[i] = std::max(largest[i], value);
    const double toOldMean = value - means[i];
    means[i] += toOldMean / double(++counts[i]);
    squares[i] += toOldMean * (value - means[i]);
  }
}

runtime::Image RunningVariance::mean() const {
  runtime::Image image(shape.width, shape.height, shape.channels);
  for (std::size_t i = 0; i < means.size(); ++i)
    image.pixels[i] = counts[i] ? float(means[i]) : std::numeric_limits<float>::quiet_NaN();
  return image;
}

template <typename Weight>
double RunningVariance::meanOf(Weight weight) const {
  double sum = 0;
  std::size_t values = 0;
  for (std::size_t i = 0; i < means.size(); ++i)
    if (counts[i] > 1) {
      sum += weight(i) * squares[i] / double(counts[i] - 1);
      ++values;
    }
  return values ? sum / double(values) : 0;
}

double RunningVariance::meanVariance() const {
  return meanOf([](std::size_t) { return 1.0; });
}

double RunningVariance::meanRelativeVariance(double epsilon) const {
  return meanOf([&](std::size_t i) { return 1 / (means[i] * means[i] + epsilon); });
}

void RunningVariance::forEachValue(const std::function<void(double, double, double)> &visit) const {
  for (std::size_t i = 0; i < means.size(); ++i)
    if (counts[i] > 0)
      visit(means[i], squares[i], std::max(largest[i] - means[i], means[i] - smallest[i]));
}

} // namespace rtsl::report
