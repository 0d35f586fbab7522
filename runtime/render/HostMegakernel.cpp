#include "runtime/render/HostMegakernel.h"

#include "runtime/accel/trees/HostBuildDevice.h"
#include "runtime/device/organisations/SampleSums.h"
#include "support/Error.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <new>
#include <utility>

namespace rtsl::runtime {

namespace {

constexpr std::uint64_t cacheLine = 64;

std::uint64_t inLines(std::uint64_t bytes) {
  return (bytes + cacheLine - 1) / cacheLine * cacheLine;
}

} // namespace

HostMegakernel::HostMegakernel(const MegakernelCode &code, FlatScene scene,
                               const RenderOptions &options, std::shared_ptr<DeviceTrees> kept)
    : Megakernel(std::move(scene), options, std::move(kept)), code(code),
      threads(options, pixelCount(), code.stackBytes) {
  makePicture(channels());
  prepare();
}

std::uint64_t HostMegakernel::laneBytes(const RtslLaunch &launch) {
  return inLines(code.laneBytes(launch.maxDepth, launch.referenceChain)); // each thread has its own
}

Megakernel::Address HostMegakernel::allocate(std::uint64_t bytes, const char *what) {
  try {
    Allocation allocation{MemoryReservation(inLines(bytes)), nullptr};
    allocation.bytes.reset(
        static_cast<std::uint8_t *>(std::aligned_alloc(cacheLine, inLines(bytes))));
    if (!allocation.bytes)
      throw std::bad_alloc();
    memory.push_back(std::move(allocation));
  } catch (const std::bad_alloc &) {
    throw Error(message::noMemoryFor(what, bytes));
  }
  return reinterpret_cast<Address>(memory.back().bytes.get());
}

void HostMegakernel::upload(Address to, const void *from, std::uint64_t bytes) {
  std::memcpy(reinterpret_cast<void *>(to), from, bytes);
}

void HostMegakernel::download(void *to, Address from, std::uint64_t bytes) {
  std::memcpy(to, reinterpret_cast<const void *>(from), bytes);
}

std::unique_ptr<BuildDevice> HostMegakernel::buildDevice() {
  return std::make_unique<HostBuildDevice>(options.threads);
}

Megakernel::Address HostMegakernel::clearedPixels() {
  if (pixels) // which are not yet known while it is prepared
    std::fill_n(pixels, pixelFloats(), 0.0f);
  return reinterpret_cast<Address>(pixels);
}

RtslPixelSums HostMegakernel::clearedSums(std::uint64_t pixels) {
  ownSums = PixelSums::make(pixels, channels(), false, false);
  return ownSums.pointers();
}

double HostMegakernel::runLanes(const RtslJob &job) {
  threads.run([&](unsigned lane) { code.runLane(&job, lane); });
  return 0;
}

double HostMegakernel::addSamples(const RtslJob &job) {
  const unsigned lanes = threads.count();
  threads.run([&](unsigned lane) { device::addSamples(job, lane, lanes); });
  return 0;
}

std::uint64_t HostMegakernel::get(Address number) {
  return __atomic_load_n(reinterpret_cast<const std::uint64_t *>(number), __ATOMIC_RELAXED);
}

void HostMegakernel::set(Address number, std::uint32_t value) {
  __atomic_store_n(reinterpret_cast<std::uint32_t *>(number), value, __ATOMIC_RELAXED);
}

} // namespace rtsl::runtime
