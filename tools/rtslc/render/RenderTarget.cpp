#include "RenderTarget.h"

#include "runtime/accel/FlatScene.h"
#include "runtime/gpu/CudaDriver.h"
#include "runtime/package/NativeCode.h"
#include "runtime/render/HostMegakernel.h"
#include "runtime/render/Renderer.h"
#include "tools/common/OptionValues.h"
#include "tools/common/Outcome.h"
#include "tools/rtslc/common/GpuArchitectures.h"
#include "tools/rtslc/common/ScenePackage.h"

namespace rtsl::tool {

namespace {

/// The fastest code for this machine.
class Host : public RenderTarget {
public:
  std::optional<runtime::Scene> compile(const typed::Module &module, const LinkRequest &request,
                                        const CompileOptions &options, Diagnostics &diagnostics,
                                        const BuildScene &build) override {
    return compileScene(module, request, options, diagnostics, build);
  }

  std::unique_ptr<runtime::Backend> prepare(const runtime::Scene &scene,
                                            const runtime::RenderOptions &options) override {
    return std::make_unique<runtime::Renderer>(scene, options);
  }
};

/// The GPU's whole program on the CPU.
class HostMegakernel : public Host {
public:
  std::unique_ptr<runtime::Backend> prepare(const runtime::Scene &scene,
                                            const runtime::RenderOptions &options) override {
    return std::make_unique<runtime::HostMegakernel>(scene.program().megakernel,
                                                     runtime::flatten(scene), options);
  }
};

class Gpu : public RenderTarget {
public:
  explicit Gpu(bool hasArchitecture) : hasArchitecture(hasArchitecture) {}

  std::optional<runtime::Scene> compile(const typed::Module &module, const LinkRequest &request,
                                        const CompileOptions &options, Diagnostics &diagnostics,
                                        const BuildScene &build) override {
    CompileOptions compile = options;
    if (!hasArchitecture)
      compile.gpu = gpuArchitecture(device.capability());
    return compileScenePackage(module, request, compile, diagnostics, build, package);
  }

  std::unique_ptr<runtime::Backend> prepare(const runtime::Scene &scene,
                                            const runtime::RenderOptions &options) override {
    const runtime::NativeCode host(package.host); // to compute the size of a lane's stack
    const std::uint64_t laneBytes =
        host.entries().laneBytes(options.maxDepth, scene.launch().referenceChain);
    auto renderer = std::make_unique<runtime::GpuRenderer>(
        device, runtime::GpuCode{package.ptx, laneBytes, package.registers},
        runtime::flatten(scene), options);
    figures = renderer->gpu();
    return renderer;
  }

  const runtime::GpuStatistics *gpu() const override { return figures ? &*figures : nullptr; }

private:
  const bool hasArchitecture;
  runtime::CudaDevice device;
  runtime::Package package; // only its code
  std::optional<runtime::GpuStatistics> figures;
};

} // namespace

nlohmann::ordered_json toJson(const runtime::TreeFigures &tree) {
  nlohmann::ordered_json document = {{"kind", nameOf(tree.kind)},
                                     {"seconds", tree.seconds},
                                     {"nodes", tree.nodes},
                                     {"items", tree.items}};
  if (tree.cost > 0)
    document["cost"] = tree.cost;
  return document;
}

nlohmann::ordered_json toJson(const runtime::GpuStatistics &gpu) {
  return {{"device", gpu.device},
          {"registers", gpu.registers},
          {"localBytes", gpu.localBytes},
          {"blocks", gpu.blocks},
          {"threadsPerBlock", gpu.threadsPerBlock},
          {"laneBytes", gpu.laneBytes},
          {"loadSeconds", gpu.loadSeconds},
          {"uploadSeconds", gpu.uploadSeconds}};
}

void addTargetOption(CLI::App &command, TargetName &target) {
  addChoice(command, "--target", target,
            Choices<TargetName>{{"host", TargetName::Host},
                                {"host-megakernel", TargetName::HostMegakernel},
                                {"gpu", TargetName::Gpu}},
            "host: the fastest code for this machine; gpu: the first CUDA device; "
            "host-megakernel: the GPU's program, on the CPU");
}

void addTraversalOption(CLI::App &command, runtime::Traversal &traversal) {
  addChoice(command, "--traversal", traversal,
            Choices<runtime::Traversal>{{"embree", runtime::Traversal::Embree},
                                        {"device", runtime::Traversal::Device}},
            "embree: fast; device: the traversal that GPUs use");
}

std::unique_ptr<RenderTarget> makeRenderTarget(TargetName name, bool hasArchitecture) {
  switch (name) {
  case TargetName::Host:
    return std::make_unique<Host>();
  case TargetName::HostMegakernel:
    return std::make_unique<HostMegakernel>();
  case TargetName::Gpu:
    break;
  }
  return std::make_unique<Gpu>(hasArchitecture);
}

} // namespace rtsl::tool
