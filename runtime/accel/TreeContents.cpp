#include "runtime/accel/TreeContents.h"

#include "runtime/device/traverse/TestItem.h"

#include <tuple>

namespace rtsl::runtime {

bool operator==(const InstanceContents &a, const InstanceContents &b) {
  const auto all = [](const InstanceContents &one) {
    return std::tie(one.items, one.mesh, one.tree, one.hasTransform, one.hasMovingVertices);
  };
  return all(a) == all(b);
}

std::vector<InstanceContents> treeContents(const RtslLaunch &launch) {
  constexpr std::uint32_t none = InstanceContents::none;
  std::vector<InstanceContents> contents;
  contents.reserve(launch.instanceCount);
  for (std::uint32_t i = 0; i < launch.instanceCount; ++i) {
    const RtslInstance &instance = launch.instances[i];
    const bool isMesh = instance.primitive == 0;
    const std::uint32_t tree =
        device::hasOwnSpace(launch, instance) ? device::treeNumber(launch, instance) : none;
    InstanceContents one = {instance.boxCount, none, tree, instance.transform != 0, false};
    if (isMesh) {
      const RtslMesh &mesh = launch.meshes[instance.mesh];
      one.items = mesh.triangleCount;
      one.mesh = instance.mesh;
      one.hasMovingVertices = mesh.keyTimes != nullptr;
    }
    contents.push_back(one);
  }
  return contents;
}

} // namespace rtsl::runtime
