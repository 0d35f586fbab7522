#include "runtime/gpu/GpuBlocks.h"

#include "runtime/gpu/GpuWaves.h"
#include "support/Error.h"
#include "support/ErrorMessages.h"

#include <algorithm>

namespace rtsl::runtime {

namespace {

constexpr std::uint32_t lanesOfWarp = 32;
/// Limits of the slots of a block. There are more slots than lanes so that the last warps of each
/// step are filled: docs/gpu.md.
constexpr std::uint32_t fewestBlockSlots = threadsPerBlock * 2,
                        mostBlockSlots = threadsPerBlock * 4;
/// What the system takes of the shared memory of a multiprocessor for each block.
constexpr std::uint64_t reservedBytes = 1024;

} // namespace

GpuBlocks::GpuBlocks(CudaDevice &device, const CudaDevice::Module &program, const WaveFacts &facts,
                     std::uint64_t stackBytes)
    : device(device), persistent(device.kernel("rtsl_persistent", program)) {
  memory.steps = facts.states + 2;
  memory.groups = facts.groups;
  memory.stackBytes = facts.hasStacks ? stackBytes : 0;
  memory.slots = 0;
  // As many blocks at once as their registers allow, but not so many that lanes lack samples.
  for (auto blocks = std::uint64_t(device.blocksAtOnce(persistent, threadsPerBlock));
       blocks > 0 && memory.slots < fewestBlockSlots; --blocks)
    memory.slots =
        std::max(memory.slots,
                 slotsIn(std::min(std::uint64_t(device.mostSharedBytes()),
                                  std::uint64_t(device.sharedBytes()) / blocks - reservedBytes)));
  if (memory.slots < lanesOfWarp)
    throw Error(message::noSharedMemoryForRays(slotBytes(), lanesOfWarp, device.mostSharedBytes()));
  device.giveSharedMemory(persistent, unsigned(memory.sharedBytes()));
}

std::uint32_t GpuBlocks::slotsIn(std::uint64_t sharedBytes) const {
  device::BlockMemory none = memory;
  none.slots = 0;
  if (sharedBytes < none.sharedBytes())
    return 0;
  const std::uint64_t slots = (sharedBytes - none.sharedBytes()) / slotBytes();
  return std::uint32_t(std::min<std::uint64_t>(mostBlockSlots, slots / lanesOfWarp * lanesOfWarp));
}

std::uint64_t GpuBlocks::slotBytes() const {
  device::BlockMemory one = memory, none = memory;
  one.slots = 64, none.slots = 0;
  return (one.sharedBytes() - none.sharedBytes() + 63) / 64;
}

unsigned GpuBlocks::setBlocks(std::uint64_t samples) {
  const std::uint64_t running = std::uint64_t(device.blocksAtOnce(persistent, threadsPerBlock)) *
                                unsigned(device.multiprocessors());
  const std::uint64_t wanted = (samples + memory.slots - 1) / memory.slots;
  const std::uint64_t perBlock = std::max<std::uint64_t>(1, stacksBytes(1));
  const std::uint64_t affordable = device.freeMemory() / 10 * 8 / perBlock;
  const std::uint64_t blocks = std::min({running, wanted, affordable});
  if (blocks == 0)
    throw Error(message::noGpuMemoryForRays(double(perBlock) / (1 << 20), memory.slots,
                                            double(device.freeMemory()) / (1 << 20)));
  return unsigned(blocks);
}

} // namespace rtsl::runtime
