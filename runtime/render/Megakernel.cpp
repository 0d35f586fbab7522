#include "runtime/render/Megakernel.h"

#include "runtime/render/Watch.h"
#include "support/Error.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <utility>

namespace rtsl::runtime {

void setOptions(FlatScene &scene, const RenderOptions &options, RtslStatus *status) {
  RtslLaunch launch = scene.launch();
  launch.width = options.width;
  launch.height = options.height;
  launch.maxDepth = options.maxDepth;
  launch.seed = options.seed;
  launch.status = status;
  scene.setLaunch(launch);
}

RenderStatistics readStatus(const RtslStatus &status, const RenderOptions &options) {
  if (status.problem != RTSL_PROBLEM_NONE)
    throw Error(ErrorCode::Internal,
                fmt::format("rays of depth {} overflow the stack that was made for them",
                            options.maxDepth));
  RenderStatistics statistics;
  // Every pixel that was taken is done, but for those that the stop has cut off.
  const Window window = windowOf(options);
  const std::uint64_t pixels = window.pixels();
  statistics.pixels = std::min(status.nextPixel, pixels) - status.unfinishedPixels;
  statistics.samples = statistics.pixels * options.samplesPerPixel + status.unfinishedSamples;
  statistics.samplesNotFinite = status.samplesNotFinite;
  statistics.pixelsWithoutSample = status.pixelsWithoutSample;
  for (const std::uint64_t rank : status.firstNotFinite)
    if (rank != 0 && statistics.notFinite.size() < options.mostNotFinite) {
      const std::uint64_t sample = ~rank, pixel = sample / options.samplesPerPixel;
      statistics.notFinite.push_back({window.x0 + std::uint32_t(pixel % window.width()),
                                      window.y0 + std::uint32_t(pixel / window.width()),
                                      std::uint32_t(sample % options.samplesPerPixel)});
    }
  addEvents(status, statistics);
  return statistics;
}

Megakernel::Megakernel(FlatScene scene, const RenderOptions &options)
    : Backend(options), scene(std::move(scene)),
      colorComponents(this->scene.launch().colorComponents) {}

void Megakernel::prepare() {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  statusAddress = allocate(sizeof(RtslStatus), "the launch");
  setOptions(scene, options, reinterpret_cast<RtslStatus *>(statusAddress));
  job.laneBytes = laneBytes(scene.launch());
  const Address sceneAddress = allocate(scene.bytes.size(), "the scene");
  scene.relocate(sceneAddress);
  upload(sceneAddress, scene.bytes.data(), scene.bytes.size());
  outputs = std::move(scene.outputs);
  scene = {};
  buildSeconds += std::chrono::duration<double>(Clock::now() - start).count();

  makePicture(colorComponents);
  job.launch = reinterpret_cast<const RtslLaunch *>(sceneAddress);
  job.status = reinterpret_cast<RtslStatus *>(statusAddress);
  const Window window = windowOf(options);
  job.left = window.x0;
  job.top = window.y0;
  job.width = window.width();
  job.height = window.height();
  clearedPixels(); // allocates them before the rays, whose number adapts to the free memory
  job.lanes = reinterpret_cast<std::uint8_t *>(
      allocate(laneCount(job.laneBytes) * job.laneBytes, "rays in flight"));
  jobAddress = allocate(sizeof job, "the launch");
}

void Megakernel::begin() {
  const RtslStatus nothing{};
  upload(statusAddress, &nothing, sizeof nothing);
  job.pixels = reinterpret_cast<float *>(clearedPixels());
  job.samplesPerPixel = samplesOfPixel;
  job.sums = sums ? placedSums : RtslPixelSums{};
  upload(jobAddress, &job, sizeof job);
}

void Megakernel::run(Watch &watch) {
  const double all = double(pixelCount());
  const Watch::Poll poll(
      watch, [&] { return double(get(statusAddress + offsetof(RtslStatus, nextPixel))) / all; },
      [&] { set(statusAddress + offsetof(RtslStatus, stop), 1); });
  kernelSeconds = runLanes(jobAddress);
}

RenderStatistics Megakernel::finish() {
  RtslStatus status;
  download(&status, statusAddress, sizeof status);
  RenderOptions ofRun = options;
  ofRun.samplesPerPixel = samplesOfPixel;
  RenderStatistics statistics = readStatus(status, ofRun);
  statistics.kernelSeconds = kernelSeconds;
  if (!sums)
    fetchPixels();
  for (const FlatScene::Output &output : outputs)
    download(output.elements, reinterpret_cast<Address>(job.launch) + output.offset, output.bytes);
  return statistics;
}

void Megakernel::uploadSums() {
  placedSums = placeSums();
}

} // namespace rtsl::runtime
