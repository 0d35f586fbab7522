#include "runtime/accel/OwnTrees.h"

#include "runtime/accel/Refit.h"
#include "runtime/accel/TreeItems.h"
#include "runtime/accel/trees/HostBuildDevice.h"
#include "support/Clock.h"

#include <utility>

namespace rtsl::runtime {

/// The trees of this process, on the device that it is.
static TreesThere treesThere(Bvh &bvh) {
  TreesThere trees = {reinterpret_cast<BuildDevice::Address>(bvh.nodes.data()),
                      reinterpret_cast<BuildDevice::Address>(bvh.items.data()),
                      std::uint32_t(bvh.nodes.size()),
                      std::uint32_t(bvh.items.size()),
                      {0}};
  for (const std::uint32_t root : bvh.meshTrees)
    if (root != 0) // a mesh with a tree of its own
      trees.roots.push_back(root);
  return trees;
}

void OwnTrees::build(const RtslLaunch &launch, unsigned threads, std::optional<TreeKind> kind) {
  const Clock::time_point start = Clock::now();
  const TreeKind chosen = treeKind(kind, itemCount(treesOf(launch)));
  std::vector<InstanceContents> ofLaunch = treeContents(launch);
  bvh = buildBvh(launch, threads, chosen);
  contents = std::move(ofLaunch);
  costsWhenBuilt.clear();
  figures = TreeFigures{chosen, std::uint32_t(bvh.nodes.size()), std::uint32_t(bvh.items.size()),
                        bvh.cost, secondsSince(start)};
}

void OwnTrees::follow(const RtslLaunch &launch, unsigned threads, std::optional<TreeKind> kind) {
  if (!figures || treeContents(launch) != contents)
    return build(launch, threads, kind);
  const Clock::time_point start = Clock::now();
  HostBuildDevice device(threads);
  Refit refit(device, treesThere(bvh), treesOf(launch));
  if (costsWhenBuilt.empty())
    costsWhenBuilt = refit.costs();
  if (areTooBad(refit.follow(reinterpret_cast<BuildDevice::Address>(&launch)), costsWhenBuilt))
    return build(launch, threads, kind);
  figures->isRefitted = true;
  figures->seconds = secondsSince(start);
}

} // namespace rtsl::runtime
