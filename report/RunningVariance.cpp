//===- RunningVariance.cpp ------------------------------------------------===//
#include "report/RunningVariance.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rtsl::report {

void RunningVariance::add(const runtime::Image &picture) {
  if (count == 0) {
    shape.width = picture.width;
    shape.height = picture.height;
    shape.channels = picture.channels;
    means.assign(picture.pixels.size(), 0.0);
    squares.assign(picture.pixels.size(), 0.0);
    smallest.assign(picture.pixels.size(), std::numeric_limits<float>::infinity());
    largest.assign(picture.pixels.size(), -std::numeric_limits<float>::infinity());
  } else if (picture.pixels.size() != means.size()) {
    throw runtime::Error(runtime::ErrorCode::BadImage, "pictures of two shapes have no common variance");
  }
  ++count;
  for (std::size_t i = 0; i < means.size(); ++i) {
    const float value = std::isfinite(picture.pixels[i]) ? picture.pixels[i] : 0.0f;
    smallest[i] = std::min(smallest[i], value);
    largest[i] = std::max(largest[i], value);
    const double toOldMean = value - means[i];
    means[i] += toOldMean / double(count);
    squares[i] += toOldMean * (value - means[i]);
  }
}

runtime::Image RunningVariance::mean() const {
  runtime::Image image(shape.width, shape.height, shape.channels);
  for (std::size_t i = 0; i < means.size(); ++i)
    image.pixels[i] = float(means[i]);
  return image;
}

double RunningVariance::meanVariance() const {
  double sum = 0;
  for (double square : squares)
    sum += square;
  return count < 2 || squares.empty() ? 0 : sum / double(count - 1) / double(squares.size());
}

double RunningVariance::meanRelativeVariance(double epsilon) const {
  double sum = 0;
  for (std::size_t i = 0; i < means.size(); ++i)
    sum += squares[i] / (means[i] * means[i] + epsilon);
  return count < 2 || squares.empty() ? 0 : sum / double(count - 1) / double(squares.size());
}

void RunningVariance::forEachValue(const std::function<void(double, double, double)> &visit) const {
  for (std::size_t i = 0; i < means.size(); ++i)
    visit(means[i], squares[i], std::max(largest[i] - means[i], means[i] - smallest[i]));
}

} // namespace rtsl::report
