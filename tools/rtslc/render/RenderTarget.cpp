#include "RenderTarget.h"

#include "runtime/accel/FlatScene.h"
#include "runtime/package/NativeCode.h"
#include "runtime/render/HostMegakernel.h"
#include "runtime/render/Renderer.h"
#include "tools/common/OptionValues.h"
#include "tools/common/Outcome.h"
#include "tools/rtslc/common/GpuArchitectures.h"
#include "tools/rtslc/common/ScenePackage.h"

#include <utility>

namespace rtsl::tool {

namespace {

runtime::KeptDeviceTrees takenFrom(KeptTrees *kept) {
  if (!kept)
    return {};
  runtime::KeptDeviceTrees trees = std::exchange(kept->ofDevices, {});
  kept->gpus.reset(); // after a failure they begin anew
  return trees;
}

/// The fastest code for this machine.
class Host : public RenderTarget {
public:
  std::optional<runtime::Scene> compile(const typed::Module &module, const LinkRequest &request,
                                        const CompileOptions &options, Diagnostics &diagnostics,
                                        const BuildScene &build) override {
    return compileScene(module, request, options, diagnostics, build);
  }

  std::unique_ptr<runtime::Backend> prepare(const runtime::Scene &scene,
                                            const runtime::RenderOptions &options,
                                            KeptTrees *kept) override {
    return std::make_unique<runtime::Renderer>(
        scene, options, kept ? std::exchange(kept->ofHost, nullptr) : nullptr);
  }

  void keepTrees(runtime::Backend &backend, KeptTrees &kept) override {
    kept.ofHost = backend.takeTrees();
  }
};

/// The GPU's whole program on the CPU.
class HostMegakernel : public Host {
public:
  std::unique_ptr<runtime::Backend> prepare(const runtime::Scene &scene,
                                            const runtime::RenderOptions &options,
                                            KeptTrees *kept) override {
    runtime::KeptDeviceTrees trees = takenFrom(kept);
    trees.resize(1);
    auto made = std::make_unique<runtime::HostMegakernel>(
        scene.program().megakernel, runtime::flatten(scene), options, trees[0]);
    backend = made.get();
    return made;
  }

  void keepTrees(runtime::Backend &, KeptTrees &kept) override {
    kept.ofDevices = {backend->treesOnDevice()};
  }

private:
  const runtime::HostMegakernel *backend = nullptr; // the last one
};

class Gpu : public RenderTarget {
public:
  Gpu(bool hasArchitecture, const GpuOptions &options, std::shared_ptr<runtime::Gpus> devices)
      : hasArchitecture(hasArchitecture), options(options), devices(std::move(devices)) {}

  std::optional<runtime::Scene> compile(const typed::Module &module, const LinkRequest &request,
                                        const CompileOptions &options, Diagnostics &diagnostics,
                                        const BuildScene &build) override {
    CompileOptions compile = options;
    if (!hasArchitecture)
      compile.gpu = gpuArchitecture(devices->capability());
    return compileScenePackage(module, request, compile, diagnostics, build, package);
  }

  std::unique_ptr<runtime::Backend> prepare(const runtime::Scene &scene,
                                            const runtime::RenderOptions &render,
                                            KeptTrees *kept) override {
    const runtime::NativeCode host(package.host); // to compute the size of a lane's stack
    const std::uint64_t laneBytes =
        host.entries().laneBytes(render.maxDepth, scene.launch().referenceChain);
    const unsigned registers = options.maxRegisters ? options.maxRegisters : package.registers;
    return devices->prepare({package.ptx, laneBytes, registers, package.wave},
                            runtime::flatten(scene), render, takenFrom(kept));
  }

  void keepTrees(runtime::Backend &, KeptTrees &kept) override {
    kept.gpus = devices;
    kept.ofDevices = devices->trees();
  }

  std::vector<std::string> stateNames(const runtime::Scene &) const override {
    return package.stateNames;
  }
  std::vector<runtime::GpuStatistics> gpus() const override { return devices->statistics(); }

private:
  const bool hasArchitecture;
  const GpuOptions options;
  const std::shared_ptr<runtime::Gpus> devices;
  runtime::Package package; // only its code
};

} // namespace

nlohmann::ordered_json toJson(const runtime::TreeFigures &tree) {
  nlohmann::ordered_json document = {{"kind", nameOf(tree.kind)},
                                     {"seconds", tree.seconds},
                                     {"nodes", tree.nodes},
                                     {"items", tree.items}};
  if (tree.cost > 0)
    document["cost"] = tree.cost;
  if (tree.isRefitted)
    document["refitted"] = true;
  return document;
}

nlohmann::ordered_json toJson(const runtime::GpuStatistics &gpu) {
  nlohmann::ordered_json document = {{"device", gpu.device},
                                     {"registers", gpu.registers},
                                     {"localBytes", gpu.localBytes},
                                     {"occupancy", gpu.occupancy},
                                     {"blocks", gpu.blocks},
                                     {"threadsPerBlock", gpu.threadsPerBlock},
                                     {"laneBytes", gpu.laneBytes},
                                     {"loadSeconds", gpu.loadSeconds},
                                     {"uploadSeconds", gpu.uploadSeconds}};
  if (gpu.spillStores) {
    document["spillStores"] = *gpu.spillStores;
    document["spillLoads"] = *gpu.spillLoads;
  }
  if (gpu.samples)
    document["samples"] = *gpu.samples;
  return document;
}

void addTargetOption(CLI::App &command, TargetName &target) {
  addChoice(command, "--target", target,
            Choices<TargetName>{{"host", TargetName::Host},
                                {"host-megakernel", TargetName::HostMegakernel},
                                {"gpu", TargetName::Gpu}},
            "host: the fastest code for this machine; gpu: CUDA devices; "
            "host-megakernel: the GPU's program, on the CPU");
}

void addPixelsInTurnsOption(CLI::App &command, std::uint32_t &pixels) {
  addWhole(command, "--pixels-in-turns", pixels, 1, runtime::mostPixelsInTurns,
           "pixels, or elements of a launch, that a thread of the host computes in turns, while "
           "the rays of others wait for memory; default: by the size of the trees");
}

void addTraversalOption(CLI::App &command, runtime::Traversal &traversal) {
  addChoice(command, "--traversal", traversal,
            Choices<runtime::Traversal>{{"embree", runtime::Traversal::Embree},
                                        {"device", runtime::Traversal::Device}},
            "embree: fast; device: the traversal that GPUs use");
}

std::unique_ptr<RenderTarget> makeRenderTarget(TargetName name, bool hasArchitecture,
                                               const GpuOptions &gpu, KeptTrees *kept) {
  switch (name) {
  case TargetName::Host:
    return std::make_unique<Host>();
  case TargetName::HostMegakernel:
    return std::make_unique<HostMegakernel>();
  case TargetName::Gpu:
    break;
  }
  std::shared_ptr<runtime::Gpus> devices = kept ? kept->gpus : nullptr;
  if (!devices)
    devices = std::make_shared<runtime::Gpus>(gpu.count);
  return std::make_unique<Gpu>(hasArchitecture, gpu, std::move(devices));
}

} // namespace rtsl::tool
