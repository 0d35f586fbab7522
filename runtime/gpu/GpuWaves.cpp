#include "runtime/gpu/GpuWaves.h"

#include "runtime/gpu/PtxKernels.h"
#include "support/Clock.h"
#include "support/Error.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

namespace rtsl::runtime {

namespace {

/// The most samples in flight. More keep more lanes busy at each step, but take more memory:
/// docs/gpu.md.
constexpr std::uint64_t mostSlots = std::uint64_t(8) << 20;
/// Samples in flight get the device's free memory divided by this.
constexpr std::uint64_t memoryShare = 4;

} // namespace

GpuWaves::GpuWaves(CudaDevice &device, const CudaDevice::Module &program, const std::string &ptx,
                   const WaveFacts &facts, std::uint64_t stackBytes, std::uint32_t colorComponents)
    : device(device), begin(device.kernel("rtsl_wave_begin", program)),
      sampleKernel(device.kernel("rtsl_wave_sample", program)) {
  queueKernels.push_back(device.kernel("rtsl_wave_trace", program));
  lightKernels.emplace_back();
  memory.lightWords = 0;
  for (std::uint32_t state = 1; state <= facts.states; ++state) {
    queueKernels.push_back(
        device.kernel(fmt::format("rtsl_wave_state_{}", state).c_str(), program));
    CudaDevice::Kernel &light = lightKernels.emplace_back();
    if (!hasLightKernel(ptx, state))
      continue;
    light = device.kernel(lightKernel(state).c_str(), program);
    memory.makePlaceForLights(colorComponents);
  }
  memory.slots = 0;
  memory.queues = std::uint32_t(queueKernels.size());
  memory.groups = facts.groups;
  memory.stackBytes = facts.hasStacks ? stackBytes : 0;
}

std::string GpuWaves::lightKernel(std::size_t state) {
  return fmt::format("rtsl_wave_light_{}", state);
}

bool GpuWaves::hasLightKernel(const std::string &ptx, std::size_t state) {
  return hasKernel(ptx, lightKernel(state));
}

std::uint32_t GpuWaves::lightBytes(std::uint32_t colorComponents) {
  device::WaveMemory memory{};
  memory.makePlaceForLights(colorComponents);
  return memory.lightWords * std::uint32_t(sizeof(std::uint32_t));
}

std::uint64_t GpuWaves::slotBytes() const {
  device::WaveMemory one = memory;
  one.slots = 1024; // in which sizes that are rounded up do not count
  return one.bytes() / one.slots;
}

std::uint64_t GpuWaves::setSlots(std::uint64_t samples) {
  const std::uint64_t affordable = device.freeMemory() / memoryShare / slotBytes();
  memory.slots = std::uint32_t(std::min({mostSlots, samples, affordable}));
  if (memory.slots < std::min<std::uint64_t>(threadsPerBlock, samples))
    throw Error(message::noGpuMemoryForRays(double(threadsPerBlock * slotBytes()) / (1 << 20),
                                            threadsPerBlock,
                                            double(device.freeMemory()) / (1 << 20)));
  return memory.bytes();
}

void GpuWaves::launch(const CudaDevice::Kernel &kernel, std::uint64_t threads,
                      const void *const *arguments) {
  const auto blocks = unsigned((threads + threadsPerBlock - 1) / threadsPerBlock);
  device.launchLater(kernel, blocks, threadsPerBlock, arguments);
}

std::vector<CudaDevice::Kernel> GpuWaves::stepKernels() const {
  std::vector<CudaDevice::Kernel> kernels = queueKernels;
  kernels.insert(kernels.begin() + 1, sampleKernel);
  return kernels;
}

double GpuWaves::run(const RtslJob &job, Address rays) {
  const auto start = Clock::now();
  std::vector<std::uint32_t> counts(memory.queues);
  const std::size_t countBytes = counts.size() * sizeof counts[0];
  device.clear(rays, 2 * countBytes);
  const void *ofBegin[] = {&job};
  launch(begin, memory.slots, ofBegin);
  bool begins = true; // no sample is in flight, and the last turn was not to begin any
  for (std::uint32_t turn = 0;; turn ^= 1) {
    const Address countsOfTurn = rays + turn * countBytes;
    device.download(counts.data(), countsOfTurn, countBytes); // waits for the last turn
    const void *arguments[] = {&job, &turn};
    if (std::all_of(counts.begin(), counts.end(), [](std::uint32_t count) { return count == 0; })) {
      if (!begins)
        break;
      launch(sampleKernel, memory.slots, arguments);
      begins = false;
      continue;
    }
    for (std::size_t queue = 0; queue < counts.size(); ++queue)
      if (counts[queue] != 0) {
        if (lightKernels[queue].function)
          launch(lightKernels[queue], counts[queue], arguments);
        launch(queueKernels[queue], counts[queue], arguments);
      }
    device.clear(countsOfTurn, countBytes);
    begins = true;
  }
  return secondsSince(start);
}

} // namespace rtsl::runtime
