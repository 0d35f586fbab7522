#include "runtime/gpu/GpuRenderer.h"

#include "runtime/gpu/CudaDriver.h"
#include "runtime/render/HostMegakernel.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

namespace rtsl::runtime {

namespace {

using Clock = std::chrono::steady_clock;

/// Four warps: few enough that the last lanes of a block do not hold many others up.
constexpr unsigned threadsPerBlock = 128;

/// Registers a thread, if nobody says otherwise. More lanes that run at once are worth more than
/// what does not fit into these; docs/gpu.md has the figures.
constexpr unsigned defaultRegisters = 80;

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// As many blocks as run at once and as there is work and memory for. Throws OutOfMemory if that is
/// none.
unsigned blockCount(const CudaDevice &device, const CudaDevice::Kernel &kernel,
                    std::uint64_t pixels, std::uint64_t laneBytes) {
  const std::uint64_t running = std::uint64_t(device.blocksAtOnce(kernel, threadsPerBlock)) *
                                unsigned(device.multiprocessors());
  const std::uint64_t wanted = (pixels + threadsPerBlock - 1) / threadsPerBlock;
  // The driver takes memory of its own for each thread's local arrays when the kernel starts.
  const std::uint64_t affordable = device.freeMemory() / 10 * 8 / (threadsPerBlock * laneBytes);
  const std::uint64_t blocks = std::min({running, wanted, affordable});
  if (blocks == 0)
    throw Error(
        ErrorCode::OutOfMemory,
        fmt::format("not enough GPU memory for rays in flight: {:.1f} MiB for {} of them, and "
                    "{:.1f} are free",
                    double(threadsPerBlock * laneBytes) / (1 << 20), threadsPerBlock,
                    double(device.freeMemory()) / (1 << 20)));
  return unsigned(blocks);
}

} // namespace

Image renderOnGpu(const Package &package, const RenderOptions &options, unsigned maxRegisters,
                  RenderStatistics &statistics, GpuStatistics &gpu) {
  checkOptions(options);
  CudaDevice device;
  gpu.device = device.name();
  Clock::time_point start = Clock::now();
  device.load(package.ptx, maxRegisters ? maxRegisters : defaultRegisters);
  const CudaDevice::Kernel kernel = device.kernel("rtsl_render");
  gpu.loadSeconds = secondsSince(start);
  gpu.registers = kernel.registers;
  gpu.localBytes = kernel.localBytes;

  start = Clock::now();
  const CudaDevice::Address status = device.allocate(sizeof(RtslStatus), "the launch");
  device.clear(status, sizeof(RtslStatus));
  FlatScene scene = package.scene;
  setOptions(scene, options, reinterpret_cast<RtslStatus *>(status));
  const CudaDevice::Address sceneAddress = device.allocate(scene.bytes.size(), "the scene");
  scene.relocate(sceneAddress);
  device.upload(sceneAddress, scene.bytes.data(), scene.bytes.size());
  gpu.uploadSeconds = secondsSince(start);

  Image image = newImage(options.width, options.height, scene.launch().colorComponents);
  const std::size_t pixelBytes = image.pixels.size() * sizeof(float);
  const CudaDevice::Address pixels = device.allocate(pixelBytes, "the picture");

  RtslJob job{};
  job.launch = reinterpret_cast<const RtslLaunch *>(sceneAddress);
  job.status = reinterpret_cast<RtslStatus *>(status);
  job.laneBytes = package.laneBytes[options.maxDepth];
  job.pixels = reinterpret_cast<float *>(pixels);
  job.samplesPerPixel = options.samplesPerPixel;
  gpu.laneBytes = job.laneBytes;
  gpu.threadsPerBlock = threadsPerBlock;
  gpu.blocks =
      blockCount(device, kernel, std::uint64_t(options.width) * options.height, job.laneBytes);
  job.lanes = reinterpret_cast<std::uint8_t *>(device.allocate(
      std::uint64_t(gpu.blocks) * threadsPerBlock * job.laneBytes, "rays in flight"));
  CudaDevice::Address jobAddress = device.allocate(sizeof job, "the launch");
  device.upload(jobAddress, &job, sizeof job);

  start = Clock::now();
  void *arguments[] = {&jobAddress};
  device.launch(kernel, gpu.blocks, threadsPerBlock, arguments);
  const double seconds = secondsSince(start);

  RtslStatus said{};
  device.download(&said, status, sizeof said);
  readStatus(said, options, statistics);
  statistics.renderSeconds = seconds;
  device.download(image.pixels.data(), pixels, pixelBytes);
  return image;
}

} // namespace rtsl::runtime
