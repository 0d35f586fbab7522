//===- Eye.cpp ------------------------------------------------------------===//
#include "Eye.h"

#include "runtime/accel/BvhBuilder.h"
#include "runtime/accel/FlatScene.h"
#include "runtime/device/organisations/Slice.h"
#include "runtime/gpu/CudaDevice.h"
#include "runtime/gpu/GpuRenderer.h"
#include "runtime/render/HostMegakernel.h"
#include "runtime/render/Renderer.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <optional>
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

using Color = std::array<float, 3>;

/// What a renderer leaves out of its sums.
Color unlessNotFinite(const Color &color) {
  constexpr float none = std::numeric_limits<float>::quiet_NaN();
  return std::all_of(color.begin(), color.end(), [](float c) { return std::isfinite(c); })
             ? color
             : Color{none, none, none};
}

class MachineEye : public Eye {
public:
  void turnTo(const runtime::Scene &target) override {
    scene = &target;
    renderer.emplace(target, onePixel());
    launch = renderer->launch();
    sample = target.program().sample;
  }

  Color look(std::uint32_t seed) override {
    launch.seed = seed;
    float color[RTSL_MAX_COLOR];
    sample(&launch, 0, 0, 0, color);
    return unlessNotFinite({color[0], color[1], color[2]});
  }

  runtime::Image picture(const runtime::RenderOptions &options) override {
    return runtime::render(*scene, options);
  }

private:
  const runtime::Scene *scene = nullptr;
  std::optional<runtime::Renderer> renderer;
  RtslLaunch launch{};
  decltype(runtime::Program::sample) sample = nullptr;
};

/// The alignment of megakernels: a cache line.
struct alignas(64) Line {
  std::uint8_t bytes[64];
};
std::uint64_t inLines(std::uint64_t bytes) {
  return (bytes + sizeof(Line) - 1) / sizeof(Line) * sizeof(Line);
}
std::vector<Line> linesFor(std::uint64_t bytes) {
  return std::vector<Line>(inLines(bytes) / sizeof(Line));
}

/// The scene in one block of bytes, as whole programs take it, and kept up with the members of its
/// objects.
class FlatCopy {
public:
  /// With a tree: there is no renderer that builds it.
  explicit FlatCopy(const runtime::Scene &scene)
      : scene(scene), flat(runtime::flatten(scene, runtime::buildBvh(scene, 1))),
        records(reinterpret_cast<std::uintptr_t>(flat.launch().records)) {}

  const runtime::Scene &source() const { return scene; }
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
    return inLines(scene.program().megakernel.laneBytes(eyeDepth, flat.launch().referenceChain));
  }

private:
  const runtime::Scene &scene;
  runtime::FlatScene flat;
  std::uint64_t records; // where they begin
};

/// What the only sample saw.
Color seen(const RtslStatus &status, const Color &sample) {
  runtime::readStatus(status, onePixel(),
                      windowOf(onePixel())); // throws if the program had too little memory
  return unlessNotFinite(sample);
}

class MegakernelEye : public Eye {
public:
  void turnTo(const runtime::Scene &scene) override {
    flat.emplace(scene);
    code = scene.program().megakernel;
    memory = linesFor(flat->size());
    lane = linesFor(flat->laneBytes());
    flat->place(reinterpret_cast<std::uintptr_t>(memory.data()), &status);
    job.launch = reinterpret_cast<const RtslLaunch *>(memory.data());
    job.status = &status;
    job.lanes = lane.data()->bytes;
    job.laneBytes = flat->laneBytes();
    job.samples = pixel.data();
    device::setWindowSize(job, 1, 1);
    job.samplesPerPixel = 1;
    device::setSampleCount(job, 1);
  }

  Color look(std::uint32_t seed) override {
    std::memcpy(memory.data(), flat->update(seed), flat->size());
    status = {};
    code.runLane(&job, 0);
    return seen(status, pixel);
  }

  runtime::Image picture(const runtime::RenderOptions &options) override {
    return runtime::HostMegakernel(code, runtime::flatten(flat->source()), options).render();
  }

private:
  runtime::MegakernelCode code;
  std::optional<FlatCopy> flat;
  std::vector<Line> memory, lane;
  RtslStatus status{};
  RtslJob job{};
  Color pixel{};
};

/// Memory of the device that grows when more is needed.
class DeviceMemory {
public:
  DeviceMemory(runtime::CudaDevice &device, const char *what) : device(device), what(what) {}

  runtime::CudaDevice::Address of(std::size_t bytes) {
    if (bytes > size) {
      size = 2 * bytes;
      address = device.allocate(size, what);
    }
    return address;
  }

private:
  runtime::CudaDevice &device;
  const char *what;
  std::size_t size = 0;
  runtime::CudaDevice::Address address = 0;
};

class GpuEye : public Eye {
public:
  explicit GpuEye(const std::string &ptx) : ptx(ptx) {
    kernel = device.kernel(runtime::renderKernelOf(ptx).name, device.compile(ptx.c_str()));
  }

  void turnTo(const runtime::Scene &scene) override {
    flat.emplace(scene);
    const std::size_t answerPlace = inLines(flat->size());
    block.assign(answerPlace + sizeof(Answer), 0);
    blockAddress = blockMemory.of(block.size());
    answerAddress = blockAddress + answerPlace;
    flat->place(blockAddress,
                reinterpret_cast<RtslStatus *>(answerAddress + offsetof(Answer, status)));
    job = {};
    job.launch = reinterpret_cast<const RtslLaunch *>(blockAddress);
    job.status = reinterpret_cast<RtslStatus *>(answerAddress + offsetof(Answer, status));
    job.laneBytes = flat->laneBytes();
    job.lanes = reinterpret_cast<std::uint8_t *>(laneMemory.of(warp * job.laneBytes));
    job.samples = reinterpret_cast<float *>(answerAddress + offsetof(Answer, pixel));
    device::setWindowSize(job, 1, 1);
    job.samplesPerPixel = job.endOfLaunch = 1;
    device::setSampleCount(job, 1);
  }

  Color look(std::uint32_t seed) override {
    std::memcpy(block.data(), flat->update(seed), flat->size());
    device.upload(blockAddress, block.data(), block.size());
    const void *arguments[] = {&job};
    device.launch(kernel, 1, warp, arguments);
    Answer answer;
    device.download(&answer, answerAddress, sizeof answer);
    return seen(answer.status, answer.pixel);
  }

  runtime::Image picture(const runtime::RenderOptions &options) override {
    runtime::CudaDevice own; // this one's program stays
    return runtime::GpuRenderer(own, {ptx, flat->laneBytes()}, runtime::flatten(flat->source()),
                                options)
        .render();
  }

private:
  /// What a launch writes.
  struct Answer {
    RtslStatus status;
    Color pixel;
  };

  static constexpr unsigned warp = 32;
  std::string ptx;
  runtime::CudaDevice device;
  runtime::CudaDevice::Kernel kernel;
  DeviceMemory blockMemory{device, "the scene"}, laneMemory{device, "rays in flight"};
  std::optional<FlatCopy> flat;
  // the scene, and behind it an Answer that is empty: both go up at once
  std::vector<std::uint8_t> block;
  runtime::CudaDevice::Address blockAddress = 0, answerAddress = 0;
  RtslJob job{};
};

} // namespace

std::unique_ptr<Eye> machineEye() {
  return std::make_unique<MachineEye>();
}
std::unique_ptr<Eye> megakernelEye() {
  return std::make_unique<MegakernelEye>();
}
std::unique_ptr<Eye> gpuEye(const std::string &ptx) {
  return std::make_unique<GpuEye>(ptx);
}

} // namespace rtsl::numerics
