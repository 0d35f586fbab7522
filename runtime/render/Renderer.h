//===- Renderer.h - the fastest backend of the CPU ------------------------===//
#pragma once

#include "runtime/render/Backend.h"
#include "runtime/scene/Scene.h"

#include <functional>
#include <memory>

namespace rtsl::runtime {

/// Calls Program::sample for each sample, on all cores, with the traversal that the options select.
/// Holds the acceleration structures of a scene, which must not change during its lifetime. The
/// picture does not depend on the number of threads.
class Renderer final : public Backend {
public:
  /// Throws OutOfMemory, OutOfRange, IncompleteScene, MissingMethod.
  Renderer(const Scene &scene, const RenderOptions &options);
  ~Renderer() override;

  /// The launch that is passed to the program, for tools that call the program themselves.
  const RtslLaunch &launch() const;
  /// Runs `work`, which calls the program, on a thread with enough stack for its frames, and waits.
  /// Throws OutOfMemory if there is no such stack. Rethrows exceptions of `work`.
  void onThread(const std::function<void()> &work) const;

private:
  std::uint32_t channels() const override;
  void begin() override;
  void run(Watch &watch) override;
  RenderStatistics finish() override;

  struct Implementation;
  std::unique_ptr<Implementation> self;
};

/// The same in one call.
Image render(const Scene &scene, const RenderOptions &options,
             RenderStatistics *statistics = nullptr);

} // namespace rtsl::runtime
