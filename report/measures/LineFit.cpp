//===- LineFit.cpp --------------------------------------------------------===//
#include "report/measures/LineFit.h"

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

double meanOfMeans(const std::vector<std::vector<double>> &byLevel) {
  double sum = 0;
  for (const std::vector<double> &values : byLevel)
    sum += mean(values);
  return sum / double(byLevel.size());
}

double dot(const std::vector<double> &a, const std::vector<double> &b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

/// Orthonormal vectors: the polynomials of the levels' effort of degree 0, 1, ...
std::vector<std::vector<double>> orthogonalPolynomials(const std::vector<double> &effort,
                                                       std::size_t count) {
  const double middle = mean(effort), size = std::max(effort.back() - effort.front(), 1e-300);
  std::vector<std::vector<double>> basis;
  for (std::size_t degree = 0; degree < count; ++degree) {
    std::vector<double> next;
    for (double value : effort)
      next.push_back(std::pow((value - middle) / size, double(degree)));
    for (const std::vector<double> &earlier : basis) {
      const double part = dot(next, earlier);
      for (std::size_t i = 0; i < next.size(); ++i)
        next[i] -= part * earlier[i];
    }
    const double length = std::sqrt(dot(next, next));
    for (double &value : next)
      value /= length;
    basis.push_back(std::move(next));
  }
  return basis;
}

/// For each round, the sum over levels of weight times value.
std::vector<double> weighted(const std::vector<double> &weights,
                             const std::vector<std::vector<double>> &values) {
  std::vector<double> sums(values.front().size(), 0.0);
  for (std::size_t level = 0; level < weights.size(); ++level)
    for (std::size_t round = 0; round < sums.size(); ++round)
      sums[round] += weights[level] * values[level][round];
  return sums;
}

/// The probability that a mean of zero gives values like these, by Student's t, two-sided.
double probabilityOfZeroMean(const std::vector<double> &values) {
  const double average = mean(values), n = double(values.size());
  double squares = 0;
  for (double value : values)
    squares += (value - average) * (value - average);
  const double error = std::sqrt(squares / (n - 1) / n);
  if (!(error > 0))
    return std::abs(average) > 1e-12 ? 0 : 1;
  return 2 * boost::math::cdf(boost::math::complement(boost::math::students_t(n - 1),
                                                      std::abs(average / error)));
}

void testFit(LineFit &fit, const Rounds &rounds, const std::vector<std::vector<double>> &basis) {
  const double meanY = meanOfMeans(rounds.y);
  std::vector<std::vector<double>> residuals = rounds.y;
  for (std::size_t level = 0; level < rounds.levels(); ++level) {
    for (std::size_t round = 0; round < rounds.rounds(); ++round)
      residuals[level][round] -= meanY + fit.slope.value * (rounds.x[level][round] - fit.meanX);
    fit.largestResidual = std::max(fit.largestResidual, std::abs(mean(residuals[level])));
  }
  const std::size_t contrasts = basis.size() - 2;
  for (std::size_t i = 0; i < contrasts; ++i)
    fit.lackOfFit =
        std::min(fit.lackOfFit,
                 double(contrasts) * probabilityOfZeroMean(weighted(basis[2 + i], residuals)));
}

} // namespace

Rounds Rounds::part(std::size_t first, std::size_t end) const {
  const auto cut = [&](const auto &values) {
    return std::decay_t<decltype(values)>(values.begin() + std::ptrdiff_t(first),
                                          values.begin() + std::ptrdiff_t(end));
  };
  return {cut(effort), cut(x), cut(y)};
}

Estimate LineFit::at(double x) const {
  const double value = intercept + slope.value * x, away = x - meanX;
  const double variance = varianceAtMean + 2 * away * covariance + away * away * varianceOfSlope;
  const double halfWidth = quantile * std::sqrt(std::max(variance, 0.0));
  return {value, value - halfWidth, value + halfWidth};
}

LineFit fitLine(const Rounds &rounds) {
  LineFit fit;
  const std::size_t levels = rounds.levels(), count = rounds.rounds();
  if (levels < 2 || count < 2)
    return fit;
  const std::vector<std::vector<double>> basis =
      orthogonalPolynomials(rounds.effort, std::min<std::size_t>(levels, 4));
  const std::vector<double> alongX = weighted(basis[1], rounds.x),
                            alongY = weighted(basis[1], rounds.y);
  const double sumX = std::accumulate(alongX.begin(), alongX.end(), 0.0);
  const double sumY = std::accumulate(alongY.begin(), alongY.end(), 0.0);
  if (sumX == 0)
    return fit;
  const double n = double(count), slope = sumY / sumX;
  fit.points = levels * count;
  fit.rounds = count;
  fit.meanX = meanOfMeans(rounds.x);
  const double meanY = meanOfMeans(rounds.y);
  fit.intercept = meanY - slope * fit.meanX;

  // The results of each round, as deviations from the mean: the slope, and the line's height at
  // meanX.
  const std::vector<double> equal(levels, 1 / double(levels));
  const std::vector<double> heightX = weighted(equal, rounds.x),
                            heightY = weighted(equal, rounds.y);
  for (std::size_t round = 0; round < count; ++round) {
    const double ofSlope = n * (alongY[round] - slope * alongX[round]) / sumX;
    const double ofHeight = heightY[round] - meanY - slope * (heightX[round] - fit.meanX);
    fit.varianceOfSlope += ofSlope * ofSlope;
    fit.varianceAtMean += ofHeight * ofHeight;
    fit.covariance += ofSlope * ofHeight;
  }
  for (double *sum : {&fit.varianceOfSlope, &fit.varianceAtMean, &fit.covariance})
    *sum /= n * (n - 1);
  fit.quantile = studentQuantile(count - 1);
  const double halfWidth = fit.quantile * std::sqrt(fit.varianceOfSlope);
  fit.slope = {slope, slope - halfWidth, slope + halfWidth};
  testFit(fit, rounds, basis);
  return fit;
}

Estimate Crossing::estimate() const {
  return meanOf(perRound);
}

std::optional<Crossing> findCrossing(const Rounds &rounds, double y) {
  std::vector<double> means;
  for (const std::vector<double> &values : rounds.y)
    means.push_back(mean(values));
  const auto found =
      std::find_if(means.begin(), means.end(), [&](double value) { return value <= y; });
  if (found == means.end())
    return std::nullopt;
  const std::size_t below = std::size_t(found - means.begin());
  Crossing crossing;
  if (below == 0) {
    crossing.perRound = rounds.x.front();
    crossing.isBound = means.front() < y;
    return crossing;
  }
  const std::size_t above = below - 1;
  const double drop = means[below] - means[above], share = (y - means[above]) / drop;
  const double slope = (mean(rounds.x[below]) - mean(rounds.x[above])) / drop; // of x over y
  for (std::size_t round = 0; round < rounds.rounds(); ++round) {
    const double x = (1 - share) * rounds.x[above][round] + share * rounds.x[below][round];
    const double excess = (1 - share) * rounds.y[above][round] + share * rounds.y[below][round] - y;
    crossing.perRound.push_back(x - slope * excess);
  }
  return crossing;
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
  // The largest k with P(fewer than k values below the median) <= 2.5 %: the k-th value from either
  // end bounds it.
  const boost::math::binomial below(double(n), 0.5);
  std::size_t k = 0;
  while (k < n / 2 && boost::math::cdf(below, double(k)) <= 1 - upperTail)
    ++k;
  k = std::max<std::size_t>(k, 1);
  return {median, values[k - 1], values[n - k]};
}

} // namespace rtsl::report
