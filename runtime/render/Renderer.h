//===- Renderer.h - the fastest backend of the CPU ------------------------===//
#pragma once

#include "runtime/render/Backend.h"
#include "runtime/scene/Scene.h"

#include <functional>
#include <memory>

namespace rtsl::runtime {

class HostScene;

/// Calls Program::sample for each sample, on all cores, with the traversal that the options select.
/// Holds the acceleration structures of a scene, which may only change in the ways that update()
/// follows. The picture does not depend on the number of threads.
class Renderer final : public Backend {
public:
  /// Throws OutOfMemory, OutOfRange, IncompleteScene, MissingMethod.
  /// `hostScene`: that of another renderer of the same scene and traversal, or null.
  Renderer(const Scene &scene, const RenderOptions &options,
           std::shared_ptr<HostScene> hostScene = nullptr);
  /// With the trees of a renderer of another scene, with the same traversal: if the scenes have the
  /// same meshes and instances (runtime/accel/TreeContents.h), the trees are updated to what has
  /// moved; otherwise new ones are built. Null: there are none.
  Renderer(const Scene &scene, const RenderOptions &options, std::shared_ptr<KeptTrees> kept);
  ~Renderer() override;

  /// To be called before render() if the scene has changed: if something has moved
  /// (Scene::moveInstance, moveMesh) trees follow it, which takes a fraction of the time of
  /// building them; if instances were added they are built anew. The picture is that of a new
  /// renderer.
  void update();
  std::shared_ptr<HostScene> hostScene() const;
  std::shared_ptr<KeptTrees> takeTrees() override;

  /// The launch that is passed to the program, for tools that call the program themselves.
  const RtslLaunch &launch() const;
  /// Runs `work`, which calls the program, on a thread with enough stack for its frames, and waits.
  /// Throws OutOfMemory if there is no such stack. Rethrows exceptions of `work`.
  void onThread(const std::function<void()> &work) const;

private:
  Renderer(const Scene &scene, const RenderOptions &options, std::shared_ptr<HostScene> hostScene,
           std::shared_ptr<KeptTrees> kept);
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
