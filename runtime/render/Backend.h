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

namespace rtsl::runtime {

class Watch;

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

protected:
  /// Throws OutOfRange for invalid options.
  explicit Backend(const RenderOptions &options);

  /// Allocates the next picture early, before long work; otherwise render() does. Throws
  /// OutOfMemory.
  void makePicture(std::uint32_t channels);
  /// The picture that is being rendered, initially 0.
  Image picture;

  std::uint64_t pixelCount() const { return std::uint64_t(options.width) * options.height; }

  const RenderOptions options;
  double buildSeconds = 0; // spent by constructors of backends

private:
  virtual std::uint32_t channels() const = 0;
  /// Resets the counts for a new rendering.
  virtual void begin() = 0;
  /// Renders until all samples are done or `watch` is stopped.
  virtual void run(Watch &watch) = 0;
  /// Copies the pixels to `picture`, and returns the statistics without the times and
  /// isUnfinished.
  virtual RenderStatistics finish() = 0;
};

} // namespace rtsl::runtime
