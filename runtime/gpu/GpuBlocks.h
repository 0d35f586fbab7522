//===- GpuBlocks.h - persistent blocks on a CUDA device -------------------===//
//
// As many blocks as run at once, each with samples in its shared memory
// (runtime/device/organisations/Persistent.h).
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/organisations/BlockMemory.h"
#include "runtime/gpu/CudaDevice.h"
#include "runtime/program/Program.h"

#include <cstdint>

namespace rtsl::runtime {

class GpuBlocks {
public:
  using Address = CudaDevice::Address;

  /// `stackBytes` are for the rays of a sample. Throws NoDevice, and OutOfMemory if the shared
  /// memory of a block is too small for the samples of a warp.
  GpuBlocks(CudaDevice &device, const CudaDevice::Module &program, const WaveFacts &facts,
            std::uint64_t stackBytes);

  const CudaDevice::Kernel &kernel() const { return persistent; }
  std::uint32_t slots() const { return memory.slots; } // of a block
  /// The bytes of a sample in flight: in shared memory, and of its stack.
  std::uint64_t slotBytes() const;
  std::uint64_t stackBytes() const { return memory.stackBytes; }

  /// Decides how many blocks run, for so many samples in all. Throws OutOfMemory.
  unsigned setBlocks(std::uint64_t samples);
  /// The global memory of the stacks of so many blocks.
  std::uint64_t stacksBytes(unsigned blocks) const {
    return std::uint64_t(blocks) * memory.slots * memory.stackBytes;
  }

private:
  std::uint32_t slotsIn(std::uint64_t sharedBytes) const;

  CudaDevice &device;
  CudaDevice::Kernel persistent;
  device::BlockMemory memory;
};

} // namespace rtsl::runtime
