//===- Gpus.h - the CUDA devices that render a picture --------------------===//
#pragma once

#include "runtime/gpu/GpuRenderer.h"
#include "runtime/render/SeveralDevices.h"

#include <cstddef>
#include <memory>
#include <vector>

namespace rtsl::runtime {

class Gpus {
public:
  /// The first `count` devices of the machine; 0: all. Throws NoDevice, OutOfRange.
  explicit Gpus(std::size_t count = 1);

  /// The oldest of their capabilities: what code for all of them is compiled for.
  int capability() const;

  /// A backend for the scene, which is not relocated; this object must outlive it. `kept`: trees
  /// that may follow to this scene. Throws NoDevice, OutOfMemory, OutOfRange; with several devices,
  /// NoDevice also for a scene that writes buffers.
  std::unique_ptr<Backend> prepare(const GpuCode &code, FlatScene scene,
                                   const RenderOptions &options, KeptDeviceTrees kept = {});
  /// Those of the last backend, while it exists. This object must outlive them.
  KeptDeviceTrees trees() const;

  /// The statistics of each device, while the last backend exists.
  std::vector<GpuStatistics> statistics() const;

private:
  std::vector<std::unique_ptr<CudaDevice>> devices;
  std::vector<const GpuRenderer *> renderers; // by device
  const SeveralDevices *several = nullptr;    // null: the backend is one renderer
};

} // namespace rtsl::runtime
