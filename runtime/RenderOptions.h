//===- RenderOptions.h - what a rendering is asked for, and what it says --===//
#pragma once

#include "runtime/device/Abi.h"

#include <atomic>
#include <cstdint>
#include <functional>

namespace rtsl::runtime {

enum class Traversal : std::uint8_t {
  Embree, // fast
  Device, // the one that GPUs run
};

/// The largest limit of depth.
constexpr std::uint32_t maxRayDepth = 256;

struct RenderOptions {
  std::uint32_t width = 960, height = 540;
  std::uint32_t samplesPerPixel = 16;
  std::uint32_t maxDepth = 8; // 0: camera rays only
  std::uint32_t seed = 1;
  std::uint32_t threads = 0; // 0: all cores
  Traversal traversal = Traversal::Embree;

  /// Called from time to time by one thread at a time, with the share that is done, in [0, 1].
  std::function<void(double)> progress;
  /// Set it from anywhere to stop: render throws Cancelled.
  const std::atomic<bool> *cancel = nullptr;
};

struct RenderStatistics {
  std::uint64_t samples = 0;
  double buildSeconds = 0;            // acceleration structures
  double renderSeconds = 0;           // samples
  std::uint64_t badRays = 0;          // not finite or without a direction: they saw color 0
  std::uint64_t retracedRays = 0;     // Embree's answer was refused, and our own traversal asked
  std::uint64_t rescaledRays = 0;     // directions too long or short for Embree
  std::uint64_t samplesNotFinite = 0; // counted as 0
  std::uint64_t exceptions[RTSL_EXCEPTIONS] = {}; // samples that ended so, by RTSL_EXCEPTION_*
};

/// Throws OutOfRange if the size, the samples or the depth make no picture.
void checkOptions(const RenderOptions &options);

/// Of a rendering: what was asked for, or one a core.
unsigned threadCount(const RenderOptions &options);

} // namespace rtsl::runtime
