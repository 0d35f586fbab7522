//===- Clock.h - time that passes ------------------------------------------===//
#pragma once

#include <chrono>

namespace rtsl {

/// Never goes backwards, whatever happens to the time of day.
using Clock = std::chrono::steady_clock;

inline double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

} // namespace rtsl
