#include "runtime/render/Stripes.h"

#include "runtime/device/organisations/Slice.h"

#include <algorithm>

namespace rtsl::runtime {

/// The stripes of a device at the beginning, if there are rows for so many.
static constexpr std::uint64_t stripesOfDevice = 32;

Stripes::Stripes(std::uint32_t rows, std::size_t devices) : kept(devices) {
  constexpr std::uint64_t band = device::rowsOfBand;
  const std::uint64_t stripes = stripesOfDevice * devices;
  const std::uint64_t height = std::max<std::uint64_t>(rows / stripes / band, 1) * band;
  std::size_t next = 0;
  for (std::uint64_t y = 0; y < rows; y += height)
    kept[next++ % devices].push_back(
        {std::uint32_t(y), std::uint32_t(std::min<std::uint64_t>(y + height, rows))});
}

std::vector<Stripes::Move> Stripes::balance(std::vector<double> seconds) {
  constexpr double leastGain = 0.02; // of the time of a pass
  std::vector<double> ofStripe;
  for (std::size_t i = 0; i < kept.size(); ++i)
    ofStripe.push_back(seconds[i] / double(std::max<std::size_t>(kept[i].size(), 1)));
  std::vector<Move> moves;
  for (;;) {
    const auto [fastest, slowest] = std::minmax_element(seconds.begin(), seconds.end());
    const auto fast = std::size_t(fastest - seconds.begin()),
               slow = std::size_t(slowest - seconds.begin());
    // On the other device it may take as long, even if that one was done at once.
    const double there = std::max(ofStripe[slow], ofStripe[fast]);
    const double longest = std::max(*slowest - ofStripe[slow], *fastest + there);
    if (kept[slow].empty() || !(longest < (1 - leastGain) * *slowest))
      return moves;
    moves.push_back({kept[slow].back(), slow, fast});
    kept[fast].push_back(kept[slow].back());
    kept[slow].pop_back();
    *slowest -= ofStripe[slow];
    *fastest += there;
  }
}

} // namespace rtsl::runtime
