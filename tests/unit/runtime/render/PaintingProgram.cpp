#include "tests/unit/runtime/render/PaintingProgram.h"

#include "runtime/device/organisations/Slice.h"

#include <chrono>
#include <thread>

namespace rtsl::test {

using namespace runtime;

std::atomic<unsigned> lanesBegun{0};

void paint(const RtslJob *job, std::uint32_t) {
  ++lanesBegun;
  const RtslLaunch &launch = *job->launch;
  const std::uint64_t samples = device::samplesOfSlice(*job);
  while (!__atomic_load_n(&job->status->stop, __ATOMIC_RELAXED)) {
    const std::uint64_t sample = __atomic_fetch_add(&job->status->nextSample, 1, __ATOMIC_RELAXED);
    if (sample >= samples)
      return;
    const device::Pixel pixel =
        device::pixelAt(*job, static_cast<std::uint32_t>(sample / job->sampleCount));
    const auto number = static_cast<std::uint32_t>(sample % job->sampleCount) + job->firstSample;
    if (job->taken && number < job->taken[pixel.number(*job)])
      continue;
    const float factor = float(number + 1);
    float *color = job->samples + 3 * sample;
    color[0] = factor * float(job->left + pixel.x);
    color[1] = factor * float(job->top + pixel.y);
    color[2] = factor * float(launch.seed);
    if (number % job->sampleCount == 0)
      std::this_thread::sleep_for(std::chrono::milliseconds(launch.maxDepth));
  }
}

MegakernelCode codeOf(void (*runLane)(const RtslJob *, std::uint32_t)) {
  MegakernelCode code;
  code.laneBytes = [](std::uint32_t, std::uint32_t) { return std::uint64_t(100); };
  code.runLane = runLane;
  return code;
}

FlatScene emptyScene() {
  RtslLaunch launch{};
  launch.colorComponents = 3;
  FlatScene scene;
  scene.bytes.resize(sizeof launch);
  scene.setLaunch(launch);
  return scene;
}

RenderOptions small() {
  RenderOptions options;
  options.width = 20;
  options.height = 10;
  options.samplesPerPixel = 3;
  options.maxDepth = 0;
  options.seed = 7;
  return options;
}

} // namespace rtsl::test
