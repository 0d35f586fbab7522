//===- Timing.h - what a call costs ---------------------------------------===//
#pragma once

#include <algorithm>
#include <chrono>
#include <limits>

namespace rtsl::numerics {

/// Nanoseconds a call, of a function that makes `calls` of them and returns something that depends
/// on all: the best of five.
template <typename Work>
double timeOf(int calls, Work work) {
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 5; ++i) {
    const auto start = std::chrono::steady_clock::now();
    [[maybe_unused]] volatile auto kept = work();
    best = std::min(
        best,
        std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count() /
            calls);
  }
  return best;
}

} // namespace rtsl::numerics
