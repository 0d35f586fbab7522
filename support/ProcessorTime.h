//===- ProcessorTime.h - time that this process has computed ---------------===//
#pragma once

#include <ctime>

namespace rtsl {

/// Seconds of all threads so far.
inline double processorSeconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

} // namespace rtsl
