#include "runtime/accel/OwnTrees.h"

#include "runtime/accel/Refit.h"
#include "runtime/accel/TreeItems.h"
#include "support/Clock.h"

#include <utility>

namespace rtsl::runtime {

namespace {} // namespace

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
  if (costsWhenBuilt.empty())
    costsWhenBuilt = costsOfTrees(bvh);
  refit(bvh, launch);
  const std::vector<double> costs = costsOfTrees(bvh);
  for (std::size_t i = 0; i < costs.size(); ++i)
    if (costs[i] > largestDegradation * costsWhenBuilt[i])
      return build(launch, threads, kind);
  figures->isRefitted = true;
  figures->seconds = secondsSince(start);
}

} // namespace rtsl::runtime
