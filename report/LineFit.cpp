//===- LineFit.cpp --------------------------------------------------------===//
#include "report/LineFit.h"

#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/students_t.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace rtsl::report {

namespace {

constexpr double upperTail = 0.975; // of an interval that holds 95 %

double studentQuantile(std::size_t degrees) {
  return boost::math::quantile(boost::math::students_t(double(degrees)), upperTail);
}

double mean(const std::vector<double> &values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
}

} // namespace

Estimate LineFit::at(double x) const {
  const double value = intercept + slope.value * x;
  const double halfWidth =
      quantile * deviation * std::sqrt(1.0 / double(points) + (x - meanX) * (x - meanX) / sumOfSquaresX);
  return {value, value - halfWidth, value + halfWidth};
}

LineFit fitLine(const std::vector<double> &x, const std::vector<double> &y) {
  LineFit fit;
  const std::size_t count = std::min(x.size(), y.size());
  if (count < 3)
    return fit;
  const double meanX = mean(x), meanY = mean(y);
  double xx = 0, xy = 0;
  for (std::size_t i = 0; i < count; ++i) {
    xx += (x[i] - meanX) * (x[i] - meanX);
    xy += (x[i] - meanX) * (y[i] - meanY);
  }
  if (!(xx > 0))
    return fit;
  const double slope = xy / xx;
  double residuals = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double residual = y[i] - meanY - slope * (x[i] - meanX);
    residuals += residual * residual;
  }
  fit.points = count;
  fit.intercept = meanY - slope * meanX;
  fit.meanX = meanX;
  fit.sumOfSquaresX = xx;
  fit.deviation = std::sqrt(residuals / double(count - 2));
  fit.quantile = studentQuantile(count - 2);
  const double halfWidth = fit.quantile * fit.deviation / std::sqrt(xx);
  fit.slope = {slope, slope - halfWidth, slope + halfWidth};
  return fit;
}

Estimate meanOf(const std::vector<double> &values) {
  if (values.empty())
    return {};
  const double value = mean(values);
  if (values.size() == 1)
    return {value, value, value};
  double squares = 0;
  for (double v : values)
    squares += (v - value) * (v - value);
  const double n = double(values.size());
  const double halfWidth = studentQuantile(values.size() - 1) * std::sqrt(squares / (n - 1) / n);
  return {value, value - halfWidth, value + halfWidth};
}

Estimate medianOf(std::vector<double> values) {
  if (values.empty())
    return {};
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  const double median = n % 2 ? values[n / 2] : 0.5 * (values[n / 2 - 1] + values[n / 2]);
  // The largest k with P(fewer than k values below the median) <= 2.5 %: the k-th value from either end bounds it.
  const boost::math::binomial below(double(n), 0.5);
  std::size_t k = 0;
  while (k < n / 2 && boost::math::cdf(below, double(k)) <= 1 - upperTail)
    ++k;
  k = std::max<std::size_t>(k, 1);
  return {median, values[k - 1], values[n - k]};
}

} // namespace rtsl::report
