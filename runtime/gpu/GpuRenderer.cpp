#include "runtime/gpu/GpuRenderer.h"

#include "runtime/gpu/GpuBuildDevice.h"
#include "support/Clock.h"
#include "support/Error.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <type_traits>

namespace rtsl::runtime {

namespace {

/// The threads of a multiprocessor that run at once.
std::uint64_t threadsAtOnce(const CudaDevice &device, const CudaDevice::Kernel &kernel,
                            unsigned ofBlock) {
  return std::uint64_t(device.blocksAtOnce(kernel, ofBlock)) * ofBlock;
}

/// The threads of a block: many if that costs no occupancy and leaves no multiprocessor without
/// work. The warps of a block begin with neighbouring samples, so its multiprocessor needs fewer
/// instructions at the same time (docs/gpu.md compares the sizes).
unsigned blockSize(const CudaDevice &device, const CudaDevice::Kernel &kernel,
                   std::uint64_t pixels) {
  constexpr unsigned large = 512;
  const bool isWorkForAll = pixels >= std::uint64_t(large) * unsigned(device.multiprocessors());
  const bool runsAsMany =
      threadsAtOnce(device, kernel, large) == threadsAtOnce(device, kernel, threadsPerBlock);
  return isWorkForAll && runsAsMany ? large : threadsPerBlock;
}

/// As many blocks as run at once and as there is work and memory for.
unsigned blockCount(const CudaDevice &device, const CudaDevice::Kernel &kernel, unsigned ofBlock,
                    std::uint64_t pixels, std::uint64_t laneBytes) {
  const std::uint64_t running =
      std::uint64_t(device.blocksAtOnce(kernel, ofBlock)) * unsigned(device.multiprocessors());
  const std::uint64_t wanted = (pixels + ofBlock - 1) / ofBlock;
  // The driver takes memory of its own for each thread's local arrays when the kernel starts.
  const std::uint64_t affordable = device.freeMemory() / 10 * 8 / (ofBlock * laneBytes);
  return unsigned(std::min({running, wanted, affordable}));
}

struct Blocks {
  unsigned count = 0, threads = 0; // threads of a block
};

/// None if there is not even memory for a small block.
Blocks chooseBlocks(const CudaDevice &device, const CudaDevice::Kernel &kernel,
                    std::uint64_t pixels, std::uint64_t laneBytes) {
  Blocks blocks;
  for (const unsigned threads : {blockSize(device, kernel, pixels), threadsPerBlock}) {
    blocks = {blockCount(device, kernel, threads, pixels, laneBytes), threads};
    if (blocks.count > 0)
      break;
  }
  return blocks;
}

} // namespace

GpuRenderer::GpuRenderer(CudaDevice &device, const GpuCode &code, FlatScene scene,
                         const RenderOptions &options, std::shared_ptr<DeviceTrees> kept)
    : Megakernel(std::move(scene), options, std::move(kept)), device(device) {
  const Clock::time_point start = Clock::now();
  program = device.compile(code.ptx, code.maxRegisters);
  loadKernels(code);
  figures.device = device.name();
  figures.loadSeconds = secondsSince(start);
  figures.registers = kernel.registers;
  figures.localBytes = kernel.localBytes;
  figures.spillStores = kernel.spillStores;
  figures.spillLoads = kernel.spillLoads;
  figures.occupancy = double(threadsAtOnce(device, kernel, threadsPerBlock)) / device.mostThreads();
  figures.laneBytes = waves ? waves->stackBytes() : blocks ? blocks->stackBytes() : code.laneBytes;
  figures.threadsPerBlock = threadsPerBlock;
  try {
    prepare();
    device.copy(device.variable("rtsl_launch", program), launchAddress(), sizeof(RtslLaunch));
  } catch (...) {
    release();
    throw;
  }
  figures.uploadSeconds = buildSeconds - (trees ? trees->seconds : 0);
  buildSeconds += figures.loadSeconds;
}

void GpuRenderer::loadKernels(const GpuCode &code) {
  sumKernel = device.kernel("rtsl_sum", program);
  if (code.wave.states == 0) {
    const RenderKernel kind = renderKernelOf(code.ptx);
    kernel = device.kernel(kind.name, program);
    if (kind.hasThreadOfSample)
      threads.emplace(device, kernel, kind);
    return;
  }
  if (code.wave.isPersistent) {
    blocks.emplace(device, program, code.wave, code.laneBytes);
    kernel = blocks->kernel();
    return;
  }
  waves.emplace(device, program, code.ptx, code.wave, code.laneBytes, channels());
  const auto &kernels = waves->stepKernels();
  kernel = *std::max_element(kernels.begin(), kernels.end(), [](const auto &a, const auto &b) {
    return a.registers < b.registers;
  });
}

GpuRenderer::~GpuRenderer() {
  release();
}

void GpuRenderer::release() {
  try {
    device.use();
    for (const Address one : memory)
      device.release(one);
    device.unload(program);
  } catch (const Error &) { // after a failure of the device nothing can be freed
  }
  memory.clear();
}

std::uint64_t GpuRenderer::raysBytes(RtslJob &job) {
  if (waves) {
    const std::uint64_t bytes = waves->setSlots(samplesInMemory());
    job.slots = waves->slots();
    figures.blocks = (waves->slots() + threadsPerBlock - 1) / threadsPerBlock;
    figures.laneBytes = waves->slotBytes();
    return bytes;
  }
  if (blocks) {
    job.slots = blocks->slots();
    figures.blocks = blocks->setBlocks(samplesInMemory());
    figures.laneBytes = blocks->slotBytes() + blocks->stackBytes();
    return blocks->stacksBytes(figures.blocks);
  }
  if (threads) {
    figures.threadsPerBlock = threads->threadsPerBlock();
    figures.blocks = threads->blocksAtOnce();
    return 0; // their only ray is in registers
  }
  const Blocks chosen = chooseBlocks(device, kernel, pixelCount(), job.laneBytes);
  figures.threadsPerBlock = chosen.threads;
  figures.blocks = chosen.count;
  if (chosen.count == 0)
    throw Error(message::noGpuMemoryForRays(double(threadsPerBlock * job.laneBytes) / (1 << 20),
                                            threadsPerBlock,
                                            double(device.freeMemory()) / (1 << 20)));
  return samplesInFlight() * job.laneBytes;
}

/// The lanes of a warp take samples of one pixel if it has as many in a pass: then they mostly run
/// the same code, and read the same of the scene. Passes of 1, 16 and 47 samples took 1.4 times as
/// long for examples/glass as one of 64.
PassSizes GpuRenderer::passSizes() const {
  constexpr std::uint64_t samplesOfFirst = 1 << 26, // some tenths of a second
      mostOfPixel = 64;
  PassSizes sizes;
  sizes.first =
      std::uint32_t(std::clamp<std::uint64_t>(samplesOfFirst / pixelCount(), 1, mostOfPixel));
  sizes.multiple = 32;
  sizes.prefersWhole = false; // the first pass has enough samples
  sizes.prefersNoSums = true; // they would be copied
  return sizes;
}

Megakernel::Address GpuRenderer::allocate(std::uint64_t bytes, const char *what) {
  memory.push_back(device.allocate(bytes, what));
  return memory.back();
}

void GpuRenderer::upload(Address to, const void *from, std::uint64_t bytes) {
  device.upload(to, from, bytes);
}

void GpuRenderer::download(void *to, Address from, std::uint64_t bytes) {
  device.download(to, from, bytes);
}

std::unique_ptr<BuildDevice> GpuRenderer::buildDevice() {
  return std::make_unique<GpuBuildDevice>(device);
}

Megakernel::Address GpuRenderer::clearedPixels() {
  if (!pixelAddress)
    pixelAddress = allocate(pixelBytes(), "the picture"); // of the most pixels
  device.clear(pixelAddress, pixelBytes());
  return pixelAddress;
}

void GpuRenderer::fetchPixels() {
  device.download(pixels, pixelAddress, pixelBytes());
}

std::uint64_t GpuRenderer::sliceBytes() {
  constexpr std::uint64_t enough = std::uint64_t(4) << 30; // 64 samples of five million pixels
  return std::min<std::uint64_t>(device.freeMemory() / 4, enough);
}

RtslPixelSums GpuRenderer::placeSums(PixelSums &sums) {
  const auto place = [&](auto &values, auto *&address) {
    const std::size_t bytes = values.size() * sizeof values[0];
    if (bytes > 0 && !address)
      address =
          reinterpret_cast<decltype(values.data())>(allocate(bytes, "the sums of the pixels"));
  };
  forEachList(place, sums, sumsOnDevice);
  return sumsOnDevice;
}

void GpuRenderer::clearSums(const PixelSums &sums, std::size_t first, std::size_t count) {
  const auto clear = [&](const void *, void *there, std::size_t bytes) {
    device.clear(reinterpret_cast<Address>(there), bytes);
  };
  forEachPart(clear, sums, sumsOnDevice, first, count);
}

void GpuRenderer::uploadSums(const PixelSums &sums, std::size_t first, std::size_t count) {
  const auto upload = [&](const void *here, void *there, std::size_t bytes) {
    device.upload(reinterpret_cast<Address>(there), here, bytes);
  };
  forEachPart(upload, sums, sumsOnDevice, first, count);
}

void GpuRenderer::fetchSums(PixelSums &sums, std::size_t first, std::size_t count) {
  const auto fetch = [&](void *here, void *there, std::size_t bytes) {
    device.download(here, reinterpret_cast<Address>(there), bytes);
  };
  forEachPart(fetch, sums, sumsOnDevice, first, count);
}

RtslPixelSums GpuRenderer::clearedSums(std::uint64_t pixels) {
  const auto clear = [&](auto *&address, std::uint64_t perPixel) {
    const std::uint64_t bytes = perPixel * sizeof *address;
    if (!address)
      address = reinterpret_cast<std::remove_reference_t<decltype(address)>>(
          allocate(pixelCount() * bytes, "the sums of the pixels"));
    device.clear(reinterpret_cast<Address>(address), pixels * bytes);
  };
  clear(ownSums.colors, channels());
  clear(ownSums.counted, 1);
  clear(ownSums.taken, 1);
  return ownSums;
}

double GpuRenderer::runLanes(const RtslJob &job) {
  if (waves)
    return waves->run(job, raysAddress());
  if (threads) // what prints has memory for the samples that run at once
    return threads->run(job, options.prints ? samplesInFlight() : samplesInMemory());
  const void *arguments[] = {&job};
  return device.launch(kernel, figures.blocks, figures.threadsPerBlock, arguments);
}

double GpuRenderer::addSamples(const RtslJob &job) {
  const void *arguments[] = {&job};
  const std::uint64_t wanted = (pixelCount() + threadsPerBlock - 1) / threadsPerBlock;
  return device.launch(sumKernel, unsigned(std::min<std::uint64_t>(wanted, 1u << 20)),
                       threadsPerBlock, arguments);
}

double GpuRenderer::launchSeconds() const {
  // The kernels of a wavefront are short.
  return waves ? std::numeric_limits<double>::infinity() : 0.25;
}

std::uint64_t GpuRenderer::get(Address number) {
  std::uint64_t value = 0;
  device.downloadMeanwhile(&value, number, sizeof value);
  return value;
}

void GpuRenderer::set(Address number, std::uint32_t value) {
  device.uploadMeanwhile(number, &value, sizeof value);
}

} // namespace rtsl::runtime
