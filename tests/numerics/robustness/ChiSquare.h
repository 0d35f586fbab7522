//===- ChiSquare.h - does a sampler match its density? --------------------===//
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

namespace rtsl::numerics {

/// Pearson's chi-square of counts in cells against what was to be expected there.
class ChiSquare {
public:
  /// Cells where less than `fewest` are expected count as one: the distribution is known of large
  /// numbers.
  void add(double expected, std::uint64_t count) {
    constexpr double fewest = 8;
    if (expected >= fewest) {
      addCell(expected, count);
    } else {
      pooledExpected += expected;
      pooledCount += count;
    }
  }
  /// From its mean, the number of cells less one, in its standard deviations.
  double deviation() const {
    ChiSquare whole = *this;
    if (pooledExpected >= 1)
      whole.addCell(pooledExpected, pooledCount);
    return std::fabs(whole.sum - (whole.cells - 1)) / std::sqrt(2.0 * (whole.cells - 1));
  }

  /// Of cells that are to have equal shares.
  static double ofEqualShares(const std::vector<std::uint64_t> &counts) {
    double all = 0;
    for (std::uint64_t count : counts)
      all += double(count);
    ChiSquare result;
    for (std::uint64_t count : counts)
      result.add(all / double(counts.size()), count);
    return result.deviation();
  }

private:
  void addCell(double expected, std::uint64_t count) {
    sum += (double(count) - expected) * (double(count) - expected) / expected;
    ++cells;
  }

  double sum = 0, pooledExpected = 0;
  std::uint64_t pooledCount = 0;
  int cells = 0;
};

} // namespace rtsl::numerics
