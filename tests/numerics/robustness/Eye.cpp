//===- Eye.cpp ------------------------------------------------------------===//
#include "Eye.h"

#include "runtime/FlatScene.h"
#include "runtime/HostMegakernel.h"
#include "runtime/Renderer.h"
#include "runtime/gpu/CudaDriver.h"

#include <cstddef>
#include <cstring>
#include <vector>

namespace rtsl::numerics {

namespace {

runtime::RenderOptions onePixel() {
  runtime::RenderOptions options;
  options.width = options.height = 1;
  options.samplesPerPixel = 1;
  options.maxDepth = eyeDepth;
  options.traversal = runtime::Traversal::Device;
  return options;
}

class MachineEye : public Eye {
public:
  explicit MachineEye(const runtime::Scene &scene)
      : renderer(scene, onePixel()), launch(renderer.launch()), sample(scene.program().sample) {}

  std::array<float, 3> look(std::uint32_t seed) override {
    launch.seed = seed;
    float color[RTSL_MAX_COLOR];
    sample(&launch, 0, 0, 0, color);
    return {color[0], color[1], color[2]};
  }

private:
  runtime::Renderer renderer;
  RtslLaunch launch;
  decltype(runtime::Program::sample) sample;
};

/// The scene in one block of bytes, as whole programs take it, and kept up with the members of its objects.
class FlatCopy {
public:
  explicit FlatCopy(const runtime::Scene &scene)
      : scene(scene), flat(runtime::flatten(scene)), records(reinterpret_cast<std::uintptr_t>(flat.launch().records)) {}

  std::size_t size() const { return flat.bytes.size(); }
  void place(std::uint64_t address, RtslStatus *status) {
    runtime::setOptions(flat, onePixel(), status);
    flat.relocate(address);
  }
  /// The bytes now.
  const std::uint8_t *update(std::uint32_t seed) {
    std::memcpy(flat.bytes.data() + records, scene.launch().records, scene.recordBytes());
    RtslLaunch launch = flat.launch();
    launch.seed = seed;
    flat.setLaunch(launch);
    return flat.bytes.data();
  }
  std::uint64_t laneBytes() const {
    constexpr std::uint64_t cacheLine = 64;
    const std::uint64_t bytes = scene.program().megakernel.laneBytes(eyeDepth, flat.launch().referenceChain);
    return (bytes + cacheLine - 1) / cacheLine * cacheLine;
  }

private:
  const runtime::Scene &scene;
  runtime::FlatScene flat;
  std::uint64_t records; // where they begin
};

struct alignas(64) Line {
  std::uint8_t bytes[64];
};
std::vector<Line> linesFor(std::uint64_t bytes) { return std::vector<Line>((bytes + sizeof(Line) - 1) / sizeof(Line)); }

class MegakernelEye : public Eye {
public:
  explicit MegakernelEye(const runtime::Scene &scene)
      : code(scene.program().megakernel), flat(scene), memory(linesFor(flat.size())), lane(linesFor(flat.laneBytes())) {
    flat.place(reinterpret_cast<std::uintptr_t>(memory.data()), &status);
    job.launch = reinterpret_cast<const RtslLaunch *>(memory.data());
    job.status = &status;
    job.lanes = lane.data()->bytes;
    job.laneBytes = flat.laneBytes();
    job.pixels = pixel.data();
    job.samplesPerPixel = 1;
  }

  std::array<float, 3> look(std::uint32_t seed) override {
    std::memcpy(memory.data(), flat.update(seed), flat.size());
    status = {};
    code.runLane(&job, 0);
    runtime::RenderStatistics statistics;
    runtime::readStatus(status, onePixel(), statistics);
    return pixel;
  }

private:
  runtime::MegakernelCode code;
  FlatCopy flat;
  std::vector<Line> memory, lane;
  RtslStatus status{};
  RtslJob job{};
  std::array<float, 3> pixel{};
};

class GpuEye : public Eye {
public:
  GpuEye(const runtime::Scene &scene, const std::string &ptx) : flat(scene) {
    device.load(ptx);
    kernel = device.kernel("rtsl_render");
    sceneAddress = device.allocate(flat.size(), "the scene");
    statusAddress = device.allocate(sizeof(RtslStatus), "the launch");
    pixelAddress = device.allocate(sizeof(float) * 3, "the picture");
    flat.place(sceneAddress, reinterpret_cast<RtslStatus *>(statusAddress));
    RtslJob job{};
    job.launch = reinterpret_cast<const RtslLaunch *>(sceneAddress);
    job.status = reinterpret_cast<RtslStatus *>(statusAddress);
    job.laneBytes = flat.laneBytes();
    job.lanes = reinterpret_cast<std::uint8_t *>(device.allocate(warp * job.laneBytes, "rays in flight"));
    job.pixels = reinterpret_cast<float *>(pixelAddress);
    job.samplesPerPixel = 1;
    jobAddress = device.allocate(sizeof job, "the launch");
    device.upload(jobAddress, &job, sizeof job);
  }

  std::array<float, 3> look(std::uint32_t seed) override {
    device.upload(sceneAddress, flat.update(seed), flat.size());
    device.clear(statusAddress, sizeof(RtslStatus));
    void *arguments[] = {&jobAddress};
    device.launch(kernel, 1, warp, arguments);
    RtslStatus status;
    device.download(&status, statusAddress, sizeof status);
    runtime::RenderStatistics statistics;
    runtime::readStatus(status, onePixel(), statistics);
    std::array<float, 3> pixel;
    device.download(pixel.data(), pixelAddress, sizeof pixel);
    return pixel;
  }

private:
  static constexpr unsigned warp = 32;
  runtime::CudaDevice device;
  runtime::CudaDevice::Kernel kernel;
  FlatCopy flat;
  runtime::CudaDevice::Address sceneAddress = 0, statusAddress = 0, pixelAddress = 0, jobAddress = 0;
};

} // namespace

std::unique_ptr<Eye> machineEye(const runtime::Scene &scene) { return std::make_unique<MachineEye>(scene); }
std::unique_ptr<Eye> megakernelEye(const runtime::Scene &scene) { return std::make_unique<MegakernelEye>(scene); }
std::unique_ptr<Eye> gpuEye(const runtime::Scene &scene, const std::string &ptx) {
  return std::make_unique<GpuEye>(scene, ptx);
}

} // namespace rtsl::numerics
