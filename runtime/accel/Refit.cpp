#include "runtime/accel/Refit.h"

#include "runtime/accel/trees/BuildMemory.h"
#include "runtime/device/trees/Bounds.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace rtsl::runtime {

using namespace device::build;

//===----------------------------------------------------------------------===//
// Trees that follow
//===----------------------------------------------------------------------===//

/// For each tree its first item, and an instance that has it.
static std::vector<ItemRange> rangesOf(const SceneTrees &contents) {
  std::vector<ItemRange> ranges = {{}};
  std::uint32_t first = contents.world.count;
  for (const auto &[number, items] : contents.ofMeshes) {
    if (items.count != 0)
      ranges.push_back({first, items.ranges.front().instance, RTSL_NO_HIT, false});
    first += items.count;
  }
  return ranges;
}

Refit::Refit(BuildDevice &device, TreesThere there, const SceneTrees &contents)
    : device(device), trees(std::move(there)) {
  const std::vector<ItemRange> ofTrees = rangesOf(contents);
  rangeCount = std::uint32_t(ofTrees.size());
  try {
    ranges = device.allocate(ofTrees.size() * sizeof ofTrees[0], "the tree");
    device.upload(ranges, ofTrees.data(), ofTrees.size() * sizeof ofTrees[0]);
    levels = device.allocate(trees.nodeCount * sizeof(std::uint32_t), "the tree");
    findLevels();
  } catch (...) {
    release();
    throw;
  }
}

Refit::~Refit() {
  release();
}

void Refit::release() {
  for (const BuildDevice::Address address : {ranges, levels})
    if (address)
      device.release(address);
}

TreeBuild Refit::begin() const {
  TreeBuild build{};
  build.nodes = reinterpret_cast<RtslBvhNode *>(trees.nodes);
  build.treeItems = reinterpret_cast<RtslTreeItem *>(trees.items);
  build.refit.trees = std::uint32_t(trees.roots.size());
  build.refit.levels = reinterpret_cast<std::uint32_t *>(levels);
  return build;
}

void Refit::findLevels() {
  device.upload(levels, trees.roots.data(), trees.roots.size() * sizeof trees.roots[0]);
  BuildMemory memory(device, begin(), [&](TreeBuild &build, Block &block) {
    placeSums(build, block, trees.nodeCount, device.lanes());
  });
  memory.beginSums(trees.nodeCount);
  std::uint32_t first = 0, end = std::uint32_t(trees.roots.size());
  while (first != end) {
    starts.push_back(first);
    memory.sum(BuildStep::PlaceInner, end - first, first, end);
    first = std::exchange(end, end + std::uint32_t(memory.sumOfAll()));
  }
  starts.push_back(end);
}

/// `launch` 0: nothing has moved.
std::vector<double> Refit::run(BuildDevice::Address launch) {
  TreeBuild begun = begin();
  begun.items = {reinterpret_cast<const RtslLaunch *>(launch),
                 reinterpret_cast<const ItemRange *>(ranges), rangeCount, trees.itemCount};
  BuildMemory memory(device, begun, [&](TreeBuild &build, Block &block) {
    block.place(build.refit.costsOfTrees, build.refit.trees);
    block.place(build.refit.costs, trees.nodeCount);
    block.place(build.refit.nodeBoxes, launch ? trees.nodeCount : 0);
    block.place(build.refit.itemBoxes, launch ? trees.itemCount : 0);
  });
  if (launch)
    memory.run(BuildStep::FollowItem, trees.itemCount);
  for (std::size_t level = starts.size() - 1; level-- > 0;) {
    const std::uint32_t first = starts[level], count = starts[level + 1] - first;
    if (launch)
      memory.run(BuildStep::FollowNode, count, first);
    memory.run(BuildStep::SumCosts, count, first);
  }
  std::vector<double> costs(trees.roots.size());
  device.download(costs.data(), addressOf(memory.build.refit.costsOfTrees),
                  costs.size() * sizeof costs[0]);
  return costs;
}

std::vector<double> Refit::costs() {
  return run(0);
}

std::vector<double> Refit::follow(BuildDevice::Address launch) {
  return run(launch);
}

bool areTooBad(const std::vector<double> &costs, const std::vector<double> &costsWhenBuilt) {
  return !std::equal(costs.begin(), costs.end(), costsWhenBuilt.begin(),
                     [](double now, double before) { return now <= largestDegradation * before; });
}

//===----------------------------------------------------------------------===//
// Trees whose nodes cannot be read
//===----------------------------------------------------------------------===//

/// The bits of a number below 2^10, two zeros between each.
static std::uint32_t spread(std::uint32_t bits) {
  bits = (bits | bits << 16) & 0x030000ffu;
  bits = (bits | bits << 8) & 0x0300f00fu;
  bits = (bits | bits << 4) & 0x030c30c3u;
  return (bits | bits << 2) & 0x09249249u;
}

BoxOrder::BoxOrder(const std::vector<RtslBox> &boxes) : order(boxes.size()) {
  RtslBox all = emptyBox();
  for (const RtslBox &box : boxes)
    extend(all, box);
  std::vector<std::uint32_t> codes;
  codes.reserve(boxes.size());
  for (const RtslBox &box : boxes) {
    std::uint32_t code = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double size = double(all.upper[axis]) - all.lower[axis];
      const double middle = 0.5 * (double(box.lower[axis]) + box.upper[axis]) - all.lower[axis];
      const double share = size > 0 && std::isfinite(size) ? middle / size : 0;
      code |= spread(std::uint32_t(std::clamp(share, 0.0, 1.0) * 1023)) << axis;
    }
    codes.push_back(code);
  }
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return codes[a] < codes[b]; });
  costWhenBuilt = cost(boxes);
}

double BoxOrder::cost(const std::vector<RtslBox> &boxes) const {
  std::vector<RtslBox> level;
  level.reserve(order.size());
  for (const std::uint32_t i : order)
    level.push_back(boxes[i]);
  double sum = 0;
  while (level.size() > 1) {
    for (const RtslBox &box : level)
      sum += double(halfArea(box));
    for (std::size_t i = 0; i < (level.size() + 1) / 2; ++i) {
      RtslBox joined = level[2 * i];
      if (2 * i + 1 < level.size())
        extend(joined, level[2 * i + 1]);
      level[i] = joined;
    }
    level.resize((level.size() + 1) / 2);
  }
  const double whole = level.empty() ? 0 : double(halfArea(level[0]));
  return whole > 0 && std::isfinite(sum / whole) ? sum / whole : 0;
}

double BoxOrder::degradation(const std::vector<RtslBox> &boxes) const {
  const double now = cost(boxes);
  return costWhenBuilt > 0 && now > 0 ? now / costWhenBuilt : 1;
}

} // namespace rtsl::runtime
