#include "runtime/render/passes/Passes.h"

#include <algorithm>
#include <cmath>

namespace rtsl::runtime {

/// What the time of earlier passes suggests.
static double timelySamples(const PassState &state, const PassOptions &passes,
                            const PassSizes &sizes) {
  constexpr double longestSeconds = 0.5;
  constexpr double mostTimes = 16; // the samples so far, whose time may not be typical
  if (state.samplesPerPixel == 0)
    return std::isfinite(passes.seconds) ? 1 : sizes.first;
  const double rate = state.samplesPerPixel / std::max(state.seconds, 1e-9); // per second
  const double seconds = std::min(longestSeconds, std::max(0.0, passes.seconds - state.seconds));
  return std::clamp(std::floor(rate * seconds), 1.0, mostTimes * state.samplesPerPixel);
}

std::uint32_t samplesOfPass(const PassState &state, const PassOptions &passes,
                            const PassSizes &sizes, std::uint32_t most) {
  std::uint32_t left = most - state.samplesPerPixel;
  if (passes.error > 0)
    left = std::min(left, nextMeasurement(state.samplesPerPixel) - state.samplesPerPixel);
  const double timely = timelySamples(state, passes, sizes);
  if (timely >= left)
    return left;
  const auto samples = std::uint32_t(timely);
  const std::uint32_t beyondMultiple = (state.samplesPerPixel + samples) % sizes.multiple;
  return beyondMultiple < samples ? samples - beyondMultiple : samples;
}

std::uint32_t nextMeasurement(std::uint32_t samples) {
  std::uint64_t next = 16;
  while (next <= samples)
    next += next / 4;
  return std::uint32_t(std::min<std::uint64_t>(next, 0xffffffffu));
}

} // namespace rtsl::runtime
