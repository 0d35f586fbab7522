//===- Backend.h - the interface of everything that renders ---------------===//
//
// There are three backends: the host with Embree or our own traversal (Renderer.h), and the GPU's
// whole program, on the CPU (HostMegakernel.h) or on a GPU (runtime/gpu/GpuRenderer.h). A backend
// is prepared for one scene and its program by its constructor. With the same traversal all of them
// give the same bits.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/image/Image.h"
#include "runtime/render/RenderOptions.h"
#include "runtime/render/passes/Passes.h"
#include "support/Clock.h"

#include <functional>
#include <memory>

namespace rtsl::runtime {

class Watch;
struct KeptTrees;

/// Adds the counts of rays and exceptions in a status to the statistics.
void addEvents(const RtslStatus &status, RenderStatistics &statistics);

class Backend {
public:
  virtual ~Backend();
  Backend(const Backend &) = delete;
  Backend &operator=(const Backend &) = delete;

  /// Renders a picture with the program's number of channels; each call renders it anew. Calls
  /// RenderOptions::progress with the share that is done. RenderOptions::cancel stops it: it then
  /// throws Cancelled, or returns the unfinished picture (RenderOptions::keepsUnfinished). Also
  /// throws OutOfMemory, and Internal if the program or its device fails.
  Image render(RenderStatistics *statistics = nullptr);

  /// As render(), but in passes, which continue `rendering` if it has sums; at the end it is the
  /// state that they have reached, without sums if one pass was enough. `progress` is called after
  /// each pass; the share that is done is that of RenderOptions::samplesPerPixel.
  /// RenderOptions::cancel ends it after the pass, or within a long one
  /// (PassOptions::secondsToEndPass). Throws OutOfRange if `rendering` has more samples than the
  /// options allow, or sums of another size, and what the functions of `passes` throw.
  Image renderInPasses(const PassOptions &passes,
                       const std::function<void(const PassState &)> &progress,
                       PartialRendering &rendering, RenderStatistics *statistics = nullptr);

  /// The trees of a backend that renders no more, for the next one (Renderer's constructor). Null:
  /// it has none to give.
  virtual std::shared_ptr<KeptTrees> takeTrees() { return nullptr; }

  /// What renderInPasses() takes at once.
  virtual PassSizes passSizes() const { return {}; }

protected:
  /// Throws OutOfRange for invalid options.
  explicit Backend(const RenderOptions &options);

  /// Allocates the next picture early, before long work; otherwise render() does. Throws
  /// OutOfMemory.
  void makePicture(std::uint32_t channels);
  /// The picture that is being rendered, initially 0.
  Image picture;

  std::uint64_t pixelCount() const { return windowOf(options).pixels(); }

  const RenderOptions options;
  std::uint32_t samplesOfPixel = 0; // run() renders each pixel until it has so many
  PixelSums *sums = nullptr;        // run() continues them; null: pixels begin without samples
  double buildSeconds = 0;          // spent by constructors of backends
  std::optional<TreeFigures> trees; // RenderStatistics::tree
  bool isRefitted = false;          // RenderStatistics::isRefitted

private:
  virtual std::uint32_t channels() const = 0;
  /// Resets the counts for a new rendering.
  virtual void begin() = 0;
  /// Renders until all samples are done or `watch` is stopped.
  virtual void run(Watch &watch) = 0;
  /// Copies the pixels to `picture`, unless there are sums, and returns the statistics of the last
  /// run, without the times and isUnfinished.
  virtual RenderStatistics finish() = 0;
  /// Copies `sums`, which have so many samples, to where run() continues them, and back. Backends
  /// that use them where they are have nothing to do.
  virtual void uploadSums(const SampleCounts &) {}
  virtual void fetchSums() {}

  /// render(); `watched`: the options for what stops it.
  Image renderAtOnce(const RenderOptions &watched, RenderStatistics *statistics);

  bool isCancelled() const { return options.cancel && *options.cancel; }
  bool isOnePass(const PassOptions &passes, const PartialRendering &rendering) const;
  Image renderOnePass(const PassOptions &passes,
                      const std::function<void(const PassState &)> &progress,
                      PartialRendering &rendering, RenderStatistics *statistics);
  SampleCounts takeSums(PartialRendering &rendering, const PassOptions &passes);
  void measure(const PassOptions &passes, PartialRendering &rendering);
  bool runPass(const PassState &state, Clock::time_point pause, double secondsToEnd,
               RenderStatistics &met);
  bool triesWhole(const PassOptions &passes, const PartialRendering &rendering) const;
  bool tryWhole(const PassOptions &passes, PartialRendering &rendering);
  void runPasses(const PassOptions &passes, const std::function<void(const PassState &)> &progress,
                 const SampleCounts &before, PartialRendering &rendering);
};

} // namespace rtsl::runtime
