//===- GpuThreads.h - a thread for each sample on a CUDA device -----------===//
//
// Programs whose samples all take about the same time are rendered by as many threads as there are
// samples, or pixels (runtime/device/organisations/WholeSamples.h): the GPU itself gives a
// multiprocessor another block when one is done. Threads that take one sample after the other from
// a counter wait for it, and keep in registers how far they are.
//
// Such a launch cannot be stopped. So each takes as many samples as take a twentieth of a second at
// the speed of the one before.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/organisations/Job.h"
#include "runtime/gpu/CudaDevice.h"

#include <cstdint>
#include <string>

namespace rtsl::runtime {

/// The kernel that renders, of a program that is no wavefront.
struct RenderKernel {
  const char *name;
  bool hasThreadOfSample = false; // a thread for each sample
  bool hasThreadOfPixel = false;  // ... or for each pixel, where RtslJob::mayTakePixels is set
};

/// The one that PTX of a program has.
RenderKernel renderKernelOf(const std::string &ptx);

class GpuThreads {
public:
  /// `kind` has a thread for each sample.
  GpuThreads(CudaDevice &device, const CudaDevice::Kernel &kernel, const RenderKernel &kind);

  unsigned threadsPerBlock() const { return ofBlock; }
  unsigned blocksAtOnce() const { return atOnce; } // that run

  /// Renders samples of the slice from RtslJob::firstOfLaunch on, at most so many, and waits for
  /// them. Returns the seconds that this took.
  double run(const RtslJob &job, std::uint64_t mostSamples);

private:
  CudaDevice &device;
  CudaDevice::Kernel kernel;
  RenderKernel kind;
  unsigned ofBlock, atOnce;
  double perSecond = 0; // samples of the last launch; 0: there was none
};

} // namespace rtsl::runtime
