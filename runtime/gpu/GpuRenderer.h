//===- GpuRenderer.h - a package on a CUDA device -------------------------===//
#pragma once

#include "runtime/image/Image.h"
#include "runtime/package/Package.h"

#include <string>

namespace rtsl::runtime {

/// What ran, for people who ask how fast it was and why.
struct GpuStatistics {
  std::string device;
  int registers = 0, localBytes = 0; // of a thread
  unsigned blocks = 0, threadsPerBlock = 0;
  std::uint64_t laneBytes = 0;
  double loadSeconds = 0;   // the driver's compiler, on PTX that it has not seen
  double uploadSeconds = 0; // the scene
};

/// Renders a package on the first CUDA device. `maxRegisters` 0: as the code wants. Throws
/// NoDevice, OutOfMemory, OutOfRange.
Image renderOnGpu(const Package &package, const RenderOptions &options, unsigned maxRegisters,
                  RenderStatistics &statistics, GpuStatistics &gpu);

} // namespace rtsl::runtime
