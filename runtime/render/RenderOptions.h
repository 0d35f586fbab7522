//===- RenderOptions.h - options and results of a rendering ---------------===//
#pragma once

#include "runtime/accel/TreeKind.h"
#include "runtime/device/organisations/Job.h"
#include "support/Fibers.h"

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <tuple>
#include <vector>

namespace rtsl::runtime {

enum class Traversal : std::uint8_t {
  Embree, // fast
  Device, // the one that GPUs run
};

/// The largest depth limit.
constexpr std::uint32_t maxRayDepth = 256;
/// The largest width of a picture with more than one row, and its largest height.
constexpr std::uint32_t mostPixelsOfSide = 65536;
/// The largest width of a launch with one row.
constexpr std::uint32_t mostLaunchWidth = 1u << 28;
/// The most indices of a launch of three dimensions, and its most rows.
constexpr std::uint32_t mostLaunchIndices = 1u << 28, mostLaunchRows = 1u << 24;
constexpr std::uint32_t mostSamplesPerPixel = 0x7fffffff;
constexpr std::uint32_t mostThreads = 1024;
constexpr std::uint32_t mostPixelsInTurns = Fibers::most;

/// A part of a picture: columns x0 to x1 - 1 and rows y0 to y1 - 1, from the top left.
struct Window {
  std::uint32_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;

  std::uint32_t width() const { return x1 - x0; }
  std::uint32_t height() const { return y1 - y0; }
  std::uint64_t pixels() const { return std::uint64_t(width()) * height(); }
};

struct RenderOptions {
  /// All rows: those of a launch of three dimensions are `slices` times as many as it has in y.
  std::uint32_t width = 960, height = 540;
  std::uint32_t slices = 1;
  std::optional<Window>
      crop; // only these pixels are rendered: those of the whole picture, bit for bit
  std::uint32_t samplesPerPixel = 16;
  std::uint32_t maxDepth = 8; // 0: camera rays only
  std::uint32_t seed = 1;
  std::uint32_t threads = 0; // 0: all cores
  /// Of each thread of the host: it renders so many pixels in turns (support/Fibers.h), at most
  /// mostPixelsInTurns. 0: by the size of the trees.
  std::uint32_t pixelsInTurns = 0;
  Traversal traversal = Traversal::Embree;
  std::optional<TreeKind> tree; // of the traversal of GPUs; nothing: treeKind decides

  /// False, for a launch that writes buffers: the megakernel neither keeps nor adds up samples, and
  /// the picture is black. Not for renderings in passes.
  bool wantsPicture = true;

  /// Called from time to time by one thread at a time, with the share that is done, in [0, 1].
  std::function<void(double)> progress;
  /// Any thread may set it to stop the rendering: then render() throws Cancelled,
  const std::atomic<bool> *cancel = nullptr;
  /// or, with this, returns the unfinished picture: the mean of the samples so far in each pixel,
  /// and black where there are none.
  bool keepsUnfinished = false;

  /// The program has code for `print`.
  bool prints = false;

  /// For a megakernel that counts its steps: the number of its states. 0: it does not.
  std::size_t countedStates = 0;

  /// Renderings in passes only, with a limit of their error: pixels end one by one (Adaptive.h).
  bool isAdaptive = false;

  /// The value of a pixel that has no finite sample. The megakernel always makes it 0.
  float withoutSample = 0;
  /// How many samples that are not finite the statistics name: the first in the order of rows,
  /// columns and samples. The megakernel names no more than RTSL_FIRST_NOT_FINITE.
  std::size_t mostNotFinite = RTSL_FIRST_NOT_FINITE;
};

/// One sample of a picture.
struct SampleId {
  std::uint32_t x = 0, y = 0, sample = 0;
};
inline bool operator<(const SampleId &a, const SampleId &b) {
  return std::tie(a.y, a.x, a.sample) < std::tie(b.y, b.x, b.sample);
}

struct RenderStatistics {
  std::uint64_t samples = 0,
                pixels = 0;              // the requested ones, unless the rendering is unfinished
  std::uint64_t openPixels = 0;          // of an adaptive rendering: those that need more samples
  bool isUnfinished = false;             // it was stopped: RenderOptions::keepsUnfinished
  double buildSeconds = 0;               // acceleration structures
  std::optional<TreeFigures> tree;       // of the traversal of GPUs, if there is one
  bool isRefitted = false;               // trees of an earlier scene have followed to this one
  double renderSeconds = 0;              // samples
  double processorSeconds = 0;           // of all threads of the process meanwhile
  double kernelSeconds = 0;              // of these, on a GPU, by its own clock; otherwise 0
  std::uint64_t badRays = 0;             // not finite or without a direction: they saw color 0
  std::uint64_t retracedRays = 0;        // beyond what Embree can follow: by our own tree
  std::uint64_t rescaledRays = 0;        // directions too long or short for Embree
  std::uint64_t raysTooDeep = 0;         // deeper than maxDepth: they were not sent
  std::uint64_t samplesNotFinite = 0;    // left out of the means of their pixels
  std::uint64_t pixelsWithoutSample = 0; // black, for none of their samples was finite
  std::vector<SampleId> notFinite;       // the first samples that are not finite
  std::uint64_t exceptions[RTSL_EXCEPTIONS] = {}; // samples that ended so, by RTSL_EXCEPTION_*
  RtslTreeVisits visits{};                        // of the traversal of GPUs, if steps are counted
  std::vector<RtslStepCount>
      steps; // of warps, by placeOfStep (runtime/device/organisations/StepCounts.h)
};

void add(const RtslTreeVisits &part, RtslTreeVisits &all);

/// Adds what a part of the rendering has met: its rays, its exceptions, and the first `most` of its
/// samples that are not finite.
void addMet(RenderStatistics &&part, std::size_t most, RenderStatistics &met);

/// Sets the size, depth and seed of a launch.
void setLaunch(RtslLaunch &launch, const RenderOptions &options);

/// Throws OutOfRange if the size, the crop, the samples or the depth make no picture.
void checkOptions(const RenderOptions &options);

/// The pixels that are rendered.
Window windowOf(const RenderOptions &options);

/// The number of threads of a rendering: the requested one, or one per core.
unsigned threadCount(const RenderOptions &options);

} // namespace rtsl::runtime
