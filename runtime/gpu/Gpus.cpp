#include "runtime/gpu/Gpus.h"

#include "support/Error.h"
#include "support/ErrorMessages.h"

#include <algorithm>
#include <utility>

namespace rtsl::runtime {

Gpus::Gpus(std::size_t count) {
  const auto available = std::size_t(CudaDevice::count());
  if (count > available)
    throw Error(message::tooFewGpus(count, available));
  for (std::size_t i = 0; i < (count ? count : available); ++i)
    devices.push_back(std::make_unique<CudaDevice>(int(i)));
}

int Gpus::capability() const {
  int oldest = devices.front()->capability();
  for (const std::unique_ptr<CudaDevice> &device : devices)
    oldest = std::min(oldest, device->capability());
  return oldest;
}

std::unique_ptr<Backend> Gpus::prepare(const GpuCode &code, FlatScene scene,
                                       const RenderOptions &options, KeptDeviceTrees kept) {
  kept.resize(devices.size());
  renderers.assign(devices.size(), nullptr);
  several = nullptr;
  if (devices.size() == 1) {
    devices.front()->use();
    auto renderer =
        std::make_unique<GpuRenderer>(*devices.front(), code, std::move(scene), options, kept[0]);
    renderers.front() = renderer.get();
    return renderer;
  }
  if (!scene.outputs.empty())
    throw Error(message::gpusShareNoBuffers());
  auto backend = std::make_unique<SeveralDevices>(
      devices.size(),
      [&](std::size_t i) -> std::unique_ptr<Megakernel> {
        devices[i]->use();
        auto renderer = std::make_unique<GpuRenderer>(*devices[i], code, scene, options, kept[i]);
        renderers[i] = renderer.get();
        return renderer;
      },
      options);
  several = backend.get();
  return backend;
}

KeptDeviceTrees Gpus::trees() const {
  KeptDeviceTrees trees;
  for (const GpuRenderer *renderer : renderers)
    trees.push_back(renderer->treesOnDevice());
  return trees;
}

std::vector<GpuStatistics> Gpus::statistics() const {
  std::vector<GpuStatistics> all;
  for (std::size_t i = 0; i < renderers.size(); ++i) {
    all.push_back(renderers[i]->gpu());
    if (renderers.size() > 1)
      all.back().samples = several->samplesOf(i);
  }
  return all;
}

} // namespace rtsl::runtime
