//===- GpuWaves.h - runs the kernels of a wavefront -----------------------===//
//
// A turn starts a kernel for each step that samples in flight wait for, one after the other, and
// then reads how many wait for each step in the next turn; a large state may have a kernel that
// looks for its lights before. When no sample is in flight any more, others begin
// (runtime/device/organisations/Wavefront.h).
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/organisations/Job.h"
#include "runtime/device/organisations/WaveMemory.h"
#include "runtime/gpu/CudaDevice.h"
#include "runtime/program/Program.h"

#include <cstdint>
#include <string>
#include <vector>

namespace rtsl::runtime {

/// The threads in a block of the kernels that render: four warps, few enough that the last lanes of
/// a block do not hold many others up.
constexpr unsigned threadsPerBlock = 128;

class GpuWaves {
public:
  using Address = CudaDevice::Address;

  /// `stackBytes` are for the rays of a sample; `ptx` is the program's. Throws NoDevice.
  GpuWaves(CudaDevice &device, const CudaDevice::Module &program, const std::string &ptx,
           const WaveFacts &facts, std::uint64_t stackBytes, std::uint32_t colorComponents);

  /// Decides how many samples are in flight, of so many that there are in all, and returns the
  /// bytes of memory that they need. Throws OutOfMemory.
  std::uint64_t setSlots(std::uint64_t samples);
  std::uint32_t slots() const { return memory.slots; }
  /// The bytes of a sample in flight.
  std::uint64_t slotBytes() const;
  std::uint64_t stackBytes() const { return memory.stackBytes; }

  /// Runs the job, with `rays` of the size that setSlots() returned. Returns the seconds.
  double run(const RtslJob &job, Address rays);

  /// The kernel that looks for the lights of a state (KnownLights.h), of which there may be none.
  static std::string lightKernel(std::size_t state);
  static bool hasLightKernel(const std::string &ptx, std::size_t state);
  /// What a sample in flight takes for it.
  static std::uint32_t lightBytes(std::uint32_t colorComponents);

  /// The kernels in the order of the steps: traversal, the beginning of samples, and states.
  std::vector<CudaDevice::Kernel> stepKernels() const;

private:
  void launch(const CudaDevice::Kernel &kernel, std::uint64_t threads,
              const void *const *arguments);

  CudaDevice &device;
  CudaDevice::Kernel begin, sampleKernel;
  std::vector<CudaDevice::Kernel> queueKernels; // traversal, and states
  // by queue: looks for the lights of its slots first (KnownLights.h); no function: there is none
  std::vector<CudaDevice::Kernel> lightKernels;
  device::WaveMemory memory;
};

} // namespace rtsl::runtime
