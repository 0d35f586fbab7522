//===- Eye.h - one ray through a scene, on each path ----------------------===//
#pragma once

#include "Path.h"

#include "runtime/device/ray/Abi.h"
#include "runtime/image/Image.h"
#include "runtime/render/RenderOptions.h"
#include "runtime/scene/Scene.h"

#include <array>
#include <cstdint>
#include <memory>
#include <string>

namespace rtsl::numerics {

/// What a camera ray sees: a picture of one pixel and one sample, by our own traversal. Members of
/// the scene's objects may be changed between looks, where scene.launch().records has them.
class Eye {
public:
  virtual ~Eye() = default;
  /// Looks at this scene from now on, which must be of the eye's program and stay where it is.
  virtual void turnTo(const runtime::Scene &scene) = 0;
  /// A color that is not finite has no finite component.
  virtual std::array<float, 3> look(std::uint32_t seed) = 0;
  /// A picture of the scene, by the renderer of the path.
  virtual runtime::Image picture(const runtime::RenderOptions &options) = 0;
};

/// Rays of at most this depth are followed.
constexpr std::uint32_t eyeDepth = 8;

/// By the program's `sample`.
std::unique_ptr<Eye> machineEye();
/// By the megakernel of the program.
std::unique_ptr<Eye> megakernelEye();
/// By the kernel in `ptx`, made of the same shaders as the megakernel of the scene's program.
/// Throws NoDevice.
std::unique_ptr<Eye> gpuEye(const std::string &ptx);

} // namespace rtsl::numerics
