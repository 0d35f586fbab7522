//===- HeavyTail.cpp ------------------------------------------------------===//
#include "report/measures/HeavyTail.h"

#include "report/measures/ErrorMetrics.h"

#include <boost/math/distributions/students_t.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace rtsl::report {

namespace {

constexpr double mostOfTheSpread = 0.5;
constexpr double fewestForTails = 20; // values for an estimate of a tail index

} // namespace

bool TailEvidence::isHeavy() const {
  return runs >= 3 && (maximumShare > std::max(mostOfTheSpread, normalShare) || tailIndex < 2);
}

std::string TailEvidence::text() const {
  std::string text = fmt::format("one of {} runs has {:.0f} % of the spread of a typical pixel",
                                 runs, 100 * maximumShare);
  if (std::isfinite(tailIndex))
    text += fmt::format("; the tail index is at most {:.2g}", tailIndex);
  return text;
}

double normalMaximumShare(std::size_t runs) {
  if (runs < 3)
    return 1;
  const double n = double(runs), once = 1e-3;
  const boost::math::students_t student(n - 2);
  const double t = boost::math::quantile(boost::math::complement(student, once / (2 * n)));
  return (n - 1) / n * t * t / (n - 2 + t * t);
}

double hillIndex(std::vector<double> values, std::size_t count) {
  if (count == 0 || values.size() <= count)
    return std::numeric_limits<double>::infinity();
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(count), values.end(),
                   std::greater<>());
  const double threshold = values[count];
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i)
    sum += std::log(values[i] / threshold);
  return sum > 0 ? double(count) / sum : std::numeric_limits<double>::infinity();
}

TailEvidence findTail(const RunningVariance &runs) {
  TailEvidence evidence;
  evidence.runs = std::uint32_t(runs.pictures());
  evidence.normalShare = normalMaximumShare(runs.pictures());
  // Once for the values themselves, for RMSE, and once relative to the mean, for relMSE.
  double largest = 0, all = 0, largestRelative = 0, allRelative = 0;
  std::vector<double> deviations;
  runs.forEachValue([&](double mean, double squares, double deviation) {
    const double scale = mean * mean + relMseEpsilon;
    largest += deviation * deviation;
    all += squares;
    largestRelative += deviation * deviation / scale;
    allRelative += squares / scale;
    if (deviation > 0)
      deviations.push_back(deviation / std::sqrt(scale));
  });
  if (all > 0)
    evidence.maximumShare = std::max(largest / all, largestRelative / allRelative);
  const double count = std::max(fewestForTails, double(deviations.size()) / 200);
  evidence.tailIndex =
      hillIndex(std::move(deviations), std::size_t(count)) * (1 + 2 / std::sqrt(count));
  return evidence;
}

} // namespace rtsl::report
