//===- Renderer.h - from a scene to an image ------------------------------===//
#pragma once

#include "runtime/image/Image.h"
#include "runtime/render/RenderOptions.h"
#include "runtime/scene/Scene.h"

#include <memory>

namespace rtsl::runtime {

/// Holds the acceleration structures of a scene, which must stay as it is meanwhile.
class Renderer {
public:
  /// Throws OutOfMemory, OutOfRange, IncompleteScene, MissingMethod.
  Renderer(const Scene &scene, const RenderOptions &options);
  ~Renderer();

  /// Renders with the program's number of channels. The result does not depend on the number of
  /// threads. Throws Cancelled, and OutOfMemory if
  /// there is none for the picture or for the stacks of rays.
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
