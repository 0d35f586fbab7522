//===- Workers.h - programs in processes of their own ---------------------===//
#pragma once

#include "Paths.h"

#include <functional>
#include <map>

namespace rtsl::random {

struct RunOptions {
  unsigned processes = 1;
  unsigned batch = 20;        // programs in one compilation
  unsigned secondsLimit = 60; // for one batch
  PathOptions paths;
};

struct FailedSeed {
  std::uint32_t seed;
  Finding finding;
};

struct Results {
  std::vector<FailedSeed> failed; // by seed
  std::size_t hit = 0;            // programs in which some ray met something
  // seeds that a path could not take yet, by reason
  std::map<std::string, std::vector<std::uint32_t>> refused;
};

/// Runs the programs of `count` seeds from `first` on. What crashes takes only its process along; a
/// batch that fails is halved until it is known which programs fail. `progress` hears how many
/// programs are done.
Results runSeeds(std::uint32_t first, std::uint32_t count, const RunOptions &options,
                 const std::function<void(std::size_t done)> &progress);

/// One program, in a process of its own.
Finding runAlone(const Program &program, const RunOptions &options);

} // namespace rtsl::random
