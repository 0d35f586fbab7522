#include "runtime/render/passes/Passes.h"

#include <algorithm>
#include <cmath>

namespace rtsl::runtime {

std::uint32_t samplesOfPass(const PassState &state, const PassOptions &passes, std::uint32_t most) {
  constexpr double longestSeconds = 0.5;
  constexpr double mostTimes = 16; // the samples so far, whose time may not be typical
  if (state.samplesPerPixel == 0)
    return 1;
  const double rate = state.samplesPerPixel / std::max(state.seconds, 1e-9); // per second
  const double seconds = std::min(longestSeconds, std::max(0.0, passes.seconds - state.seconds));
  const double samples =
      std::clamp(std::floor(rate * seconds), 1.0, mostTimes * state.samplesPerPixel);
  std::uint32_t left = most - state.samplesPerPixel;
  if (passes.error > 0)
    left = std::min(left, nextMeasurement(state.samplesPerPixel) - state.samplesPerPixel);
  return std::uint32_t(std::min(samples, double(left)));
}

std::uint32_t nextMeasurement(std::uint32_t samples) {
  std::uint64_t next = 16;
  while (next <= samples)
    next += next / 4;
  return std::uint32_t(std::min<std::uint64_t>(next, 0xffffffffu));
}

} // namespace rtsl::runtime
