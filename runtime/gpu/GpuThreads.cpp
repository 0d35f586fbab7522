#include "runtime/gpu/GpuThreads.h"

#include "runtime/device/organisations/Slice.h"
#include "runtime/gpu/PtxKernels.h"

#include <algorithm>

namespace rtsl::runtime {

namespace {

/// docs/gpu.md has the figures of other sizes.
constexpr unsigned blockOfSamples = 64, blockOfPixels = 256;
/// Of a launch; and its samples while their speed is not known.
constexpr double seconds = 0.05;
constexpr std::uint64_t firstSamples = 1 << 20;

constexpr RenderKernel kernels[] = {
    {"rtsl_render_samples", true, false}, {"rtsl_render_pixels", true, true}, {"rtsl_render"}};

} // namespace

RenderKernel renderKernelOf(const std::string &ptx) {
  const auto isThere = [&](const RenderKernel &kernel) { return hasKernel(ptx, kernel.name); };
  const RenderKernel *found = std::find_if(std::begin(kernels), std::end(kernels), isThere);
  return found == std::end(kernels) ? kernels[2] : *found;
}

GpuThreads::GpuThreads(CudaDevice &device, const CudaDevice::Kernel &kernel,
                       const RenderKernel &kind)
    : device(device), kernel(kernel), kind(kind),
      ofBlock(kind.hasThreadOfPixel ? blockOfPixels : blockOfSamples),
      atOnce(unsigned(device.blocksAtOnce(kernel, ofBlock)) * unsigned(device.multiprocessors())) {}

double GpuThreads::run(const RtslJob &job, std::uint64_t mostSamples) {
  const std::uint64_t ofThread = kind.hasThreadOfPixel && job.mayTakePixels ? job.sampleCount : 1,
                      ofFullDevice = std::uint64_t(atOnce) * ofBlock * ofThread,
                      left = device::samplesOfSlice(job) - job.firstOfLaunch;
  const double timely = perSecond > 0 ? perSecond * seconds : double(firstSamples),
               samples = std::min(std::max(timely, double(ofFullDevice)),
                                  double(std::min(mostSamples, left)));
  const std::uint64_t threads = std::max<std::uint64_t>(std::uint64_t(samples) / ofThread, 1);
  RtslJob launch = job;
  launch.endOfLaunch = std::uint32_t(job.firstOfLaunch + threads * ofThread);
  const void *arguments[] = {&launch};
  const double took =
      device.launch(kernel, unsigned((threads + ofBlock - 1) / ofBlock), ofBlock, arguments);
  if (took > 0)
    perSecond = double(threads * ofThread) / took;
  return took;
}

} // namespace rtsl::runtime
