#include "runtime/render/HostMegakernel.h"

#include "support/WorkerThreads.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <memory>
#include <thread>

namespace rtsl::runtime {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint64_t cacheLine = 64;

std::uint64_t inLines(std::uint64_t bytes) {
  return (bytes + cacheLine - 1) / cacheLine * cacheLine;
}

struct Free {
  void operator()(void *memory) const { std::free(memory); }
};
using Memory = std::unique_ptr<std::uint8_t, Free>;

Memory allocate(std::uint64_t bytes, const char *what) {
  Memory memory(static_cast<std::uint8_t *>(std::aligned_alloc(cacheLine, inLines(bytes))));
  if (!memory)
    throw Error(ErrorCode::OutOfMemory,
                fmt::format("not enough memory for {}: {} bytes", what, bytes));
  return memory;
}

/// Tells the caller how far the job is until all lanes are through, and stops it if asked.
class Watch {
public:
  Watch(RtslStatus &status, const RenderOptions &options)
      : status(status), options(options), total(double(options.width) * options.height) {
    if (options.progress || options.cancel)
      thread = std::thread([this] { run(); });
  }
  ~Watch() {
    isOver = true;
    if (thread.joinable())
      thread.join();
  }

private:
  void run() {
    while (!isOver) {
      if (options.cancel && options.cancel->load(std::memory_order_relaxed))
        __atomic_store_n(&status.stop, 1u, __ATOMIC_RELAXED);
      if (options.progress)
        options.progress(
            std::min(1.0, double(__atomic_load_n(&status.nextPixel, __ATOMIC_RELAXED)) / total));
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }

  RtslStatus &status;
  const RenderOptions &options;
  const double total;
  std::atomic<bool> isOver{false};
  std::thread thread;
};

} // namespace

void setOptions(FlatScene &scene, const RenderOptions &options, RtslStatus *status) {
  RtslLaunch launch = scene.launch();
  launch.width = options.width;
  launch.height = options.height;
  launch.maxDepth = options.maxDepth;
  launch.seed = options.seed;
  launch.status = status;
  scene.setLaunch(launch);
}

void readStatus(const RtslStatus &status, const RenderOptions &options,
                RenderStatistics &statistics) {
  if (status.problem != RTSL_PROBLEM_NONE)
    throw Error(ErrorCode::Internal,
                fmt::format("rays of depth {} overflow the stack that was made for them",
                            options.maxDepth));
  // Every pixel that was taken is done, but for those that the stop has cut off.
  const std::uint64_t pixels = std::uint64_t(options.width) * options.height;
  statistics.pixels = std::min(status.nextPixel, pixels) - status.unfinishedPixels;
  statistics.samples = statistics.pixels * options.samplesPerPixel + status.unfinishedSamples;
  statistics.isUnfinished = statistics.pixels < pixels;
  if (statistics.isUnfinished && !options.keepsUnfinished)
    throw Error(ErrorCode::Cancelled, "rendering was cancelled");
  statistics.badRays = status.badRays;
  statistics.raysTooDeep = status.raysTooDeep;
  statistics.samplesNotFinite = status.samplesNotFinite;
  statistics.pixelsWithoutSample = status.pixelsWithoutSample;
  statistics.notFinite.clear();
  for (const std::uint64_t rank : status.firstNotFinite)
    if (rank != 0 && statistics.notFinite.size() < options.mostNotFinite) {
      const std::uint64_t sample = ~rank, pixel = sample / options.samplesPerPixel;
      statistics.notFinite.push_back({std::uint32_t(pixel % options.width),
                                      std::uint32_t(pixel / options.width),
                                      std::uint32_t(sample % options.samplesPerPixel)});
    }
  std::copy_n(status.exceptions, RTSL_EXCEPTIONS, statistics.exceptions);
}

Image renderOnHost(const MegakernelCode &code, FlatScene scene, const RenderOptions &options,
                   RenderStatistics *statistics) {
  checkOptions(options);
  const Clock::time_point start = Clock::now();
  const std::uint64_t pixels = std::uint64_t(options.width) * options.height;
  const unsigned threads = unsigned(std::min<std::uint64_t>(threadCount(options), pixels));

  RtslStatus status{};
  setOptions(scene, options, &status);
  const Memory memory = allocate(scene.bytes.size(), "the scene");
  scene.relocate(reinterpret_cast<std::uintptr_t>(memory.get()));
  std::memcpy(memory.get(), scene.bytes.data(), scene.bytes.size());

  RtslJob job{};
  job.launch = reinterpret_cast<const RtslLaunch *>(memory.get());
  job.status = &status;
  job.laneBytes = inLines(code.laneBytes(options.maxDepth, job.launch->referenceChain));
  const Memory lanes = allocate(threads * job.laneBytes, "rays in flight");
  job.lanes = lanes.get();
  Image image = newImage(options.width, options.height, job.launch->colorComponents);
  job.pixels = image.pixels.data();
  job.samplesPerPixel = options.samplesPerPixel;

  {
    Watch watch(status, options);
    runOnThreads(threads, code.stackBytes, [&](unsigned lane) { code.runLane(&job, lane); });
  }

  RenderStatistics said;
  readStatus(status, options, said);
  said.renderSeconds = std::chrono::duration<double>(Clock::now() - start).count();
  if (statistics)
    *statistics = said;
  return image;
}

} // namespace rtsl::runtime
