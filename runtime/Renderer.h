//===- Renderer.h - from a scene to an image ------------------------------===//
#pragma once

#include "runtime/Image.h"
#include "runtime/Scene.h"

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>

namespace rtsl::runtime {

enum class Traversal : std::uint8_t {
  Embree, // fast
  Device, // the one that GPUs run
};

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
};

/// Holds the acceleration structures of a scene, which must stay as it is meanwhile.
class Renderer {
public:
  /// Throws OutOfMemory, OutOfRange, IncompleteScene, MissingMethod.
  Renderer(const Scene &scene, const RenderOptions &options);
  ~Renderer();

  /// Renders with the program's number of channels. The result does not depend on the number of
  /// threads. Throws Cancelled.
  Image render(RenderStatistics *statistics = nullptr);

  /// The launch that is handed to the program, for tools that call it themselves.
  const RtslLaunch &launch() const;

private:
  struct Implementation;
  std::unique_ptr<Implementation> self;
};

/// The same in one call.
Image render(const Scene &scene, const RenderOptions &options,
             RenderStatistics *statistics = nullptr);

} // namespace rtsl::runtime
