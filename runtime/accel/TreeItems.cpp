#include "runtime/accel/TreeItems.h"

#include "runtime/device/traverse/TestItem.h"

namespace rtsl::runtime {

void TreeItems::add(std::uint32_t items, std::uint32_t instance, std::uint32_t number,
                    bool isWhole) {
  if (items == 0)
    return;
  ranges.push_back({count, instance, number, isWhole});
  count += items;
}

/// The triangles of a mesh, or the primitives of an object with several.
static std::uint32_t contentsOf(const RtslLaunch &launch, const RtslInstance &instance) {
  return instance.primitive == 0 ? launch.meshes[instance.mesh].triangleCount : instance.boxCount;
}

SceneTrees treesOf(const RtslLaunch &launch) {
  SceneTrees trees;
  for (std::uint32_t i = 0; i < launch.instanceCount; ++i) {
    const RtslInstance &instance = launch.instances[i];
    const bool isOnePrimitive = instance.primitive != 0 && instance.boxCount == 0;
    if (device::hasOwnSpace(launch, instance)) {
      const auto [tree, isNew] = trees.ofMeshes.try_emplace(device::treeNumber(launch, instance));
      if (isNew)
        tree->second.add(contentsOf(launch, instance), i, RTSL_NO_HIT, false);
    }
    if (isOnePrimitive || instance.transform != 0)
      trees.world.add(1, i, i, true);
    else
      trees.world.add(contentsOf(launch, instance), i, i, false);
  }
  return trees;
}

std::uint64_t itemCount(const SceneTrees &trees) {
  std::uint64_t count = trees.world.count;
  for (const auto &[number, items] : trees.ofMeshes)
    count += items.count;
  return count;
}

} // namespace rtsl::runtime
