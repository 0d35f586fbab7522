#include "runtime/accel/trees/ClusterTree.h"

#include "runtime/accel/trees/BuildMemory.h"
#include "runtime/device/trees/Clusters.h"
#include "runtime/device/trees/Sort.h"

#include <algorithm>

namespace rtsl::runtime {

using namespace device::build;

namespace {

/// The arrays of a build, but for those of the tree.
void placeArrays(TreeBuild &build, Block &block) {
  const std::size_t n = build.count;
  const std::size_t sums = std::max<std::size_t>(n, std::size_t(digits) * tileCount(build.count));
  block.place(build.boxes, 2 * n);
  block.place(build.heights, 2 * n);
  block.place(build.children, n);
  block.place(build.choices, n);
  block.place(build.costs, n);
  block.place(build.centres, n);
  block.place(build.keys[0], n);
  block.place(build.keys[1], n);
  block.place(build.order[0], n);
  block.place(build.order[1], n);
  placeSums(build, block, sums);
  block.place(build.clusters[0], n);
  block.place(build.clusters[1], n);
  block.place(build.nearest, n);
  block.place(build.contents, n);
  // Keys are no longer needed then.
  static_assert(sizeof(WideNode) <= 2 * sizeof(std::uint64_t));
  build.wide = reinterpret_cast<WideNode *>(build.keys[0]);
}

/// Usual are 20 to 70.
constexpr std::uint32_t manyRounds = 150;

class ClusterBuilder {
public:
  ClusterBuilder(BuildDevice &device, const Items &items)
      : device(device), memory(device, buildOf(items), placeArrays) {}

  void setBoxes(const RtslBox *boxes) {
    device.upload(addressOf(build.boxes + build.count), boxes, build.count * sizeof *boxes);
  }
  void measure() { run(BuildStep::MeasureItem, build.count); }

  void sort() {
    std::uint32_t ranges = build.count;
    BuildStep step = BuildStep::RangeOfCentres;
    do {
      constexpr std::uint32_t together = 16;
      const std::uint32_t before = ranges;
      ranges = (ranges + together - 1) / together;
      run(step, ranges, before);
      step = BuildStep::JoinRanges;
    } while (ranges > 1);
    run(BuildStep::MakeKey, build.count);
    const std::uint32_t tiles = tileCount(build.count);
    for (std::uint32_t pass = 0; pass < sortPasses; ++pass) {
      run(BuildStep::CountDigits, tiles * device.lanes(), pass);
      memory.sumBefore(digits * tiles);
      run(BuildStep::MoveByDigit, tiles * device.lanes(), pass);
    }
  }

  void cluster() {
    run(BuildStep::MakeLeaf, build.count);
    Round round{0, build.count, false};
    while (round.clusters > 1) {
      run(BuildStep::FindNearest, round.clusters, round.number, round.isInPairs);
      run(BuildStep::CountCluster, round.clusters);
      memory.sumBefore(round.clusters);
      run(BuildStep::MoveCluster, round.clusters, round.number, round.isInPairs);
      const auto left = std::uint32_t(memory.sumOfAll());
      const bool isInPairs =
          round.isInPairs || left == round.clusters || round.number == manyRounds;
      round = {round.number + 1, left, isInPairs};
    }
  }

  ClusterTree widen() {
    run(BuildStep::StartWide, 1);
    ClusterTree tree;
    tree.itemCount = build.count;
    tree.cost = cost();
    std::uint32_t first = 0, size = 1, items = 0; // of the level
    while (size != 0) {
      tree.nodeCount = first + size;
      run(BuildStep::CountChildren, size, first);
      memory.sumBefore(size);
      run(BuildStep::PlaceChildren, size, first, tree.nodeCount, items);
      const std::uint64_t ofLevel = memory.sumOfAll();
      first += size;
      size = std::uint32_t(ofLevel);
      items += std::uint32_t(ofLevel >> 32);
    }
    tree.nodes = device.allocate(tree.nodeCount * sizeof(RtslBvhNode), "the tree");
    build.nodes = reinterpret_cast<RtslBvhNode *>(tree.nodes);
    if (build.items.launch)
      tree.items = device.allocate(tree.itemCount * sizeof(RtslTreeItem), "the tree");
    else
      tree.contents = device.allocate(tree.itemCount * sizeof(std::uint32_t), "the tree");
    build.treeItems = reinterpret_cast<RtslTreeItem *>(tree.items);
    if (tree.contents)
      build.contents = reinterpret_cast<std::uint32_t *>(tree.contents);
    memory.upload();
    run(BuildStep::WriteNode, tree.nodeCount);
    if (build.items.launch)
      run(BuildStep::WriteItem, tree.itemCount);
    return tree;
  }

private:
  static TreeBuild buildOf(const Items &items) {
    TreeBuild build{};
    build.items = items;
    build.count = items.count;
    return build;
  }

  void run(BuildStep step, std::uint32_t count, std::uint32_t a = 0, std::uint32_t b = 0,
           std::uint32_t c = 0) {
    memory.run(step, count, a, b, c);
  }

  /// The cost by the surface area heuristic.
  float cost() {
    const std::uint32_t root = build.count - 1; // of the nodes that are no leaves
    if (root == 0)
      return costOfNode + costOfItem;
    RtslBox box;
    Costs costs;
    device.download(&box, addressOf(build.boxes + build.count + root - 1), sizeof box);
    device.download(&costs, addressOf(build.costs + root - 1), sizeof costs);
    const float cost = costs.of[1] / halfArea(box);
    return cost > 0 && cost < device::infinity ? cost : 0;
  }

  BuildDevice &device;
  BuildMemory memory;
  TreeBuild &build = memory.build;
};

} // namespace

ClusterTree buildClusterTree(BuildDevice &device, const Items &items, const RtslBox *boxes) {
  ClusterBuilder builder(device, items);
  if (boxes)
    builder.setBoxes(boxes);
  else
    builder.measure();
  builder.sort();
  builder.cluster();
  return builder.widen();
}

void moveNodes(BuildDevice &device, BuildDevice::Address nodes, std::uint32_t count,
               std::uint32_t firstNode, std::uint32_t firstItem) {
  TreeBuild build{};
  build.nodes = reinterpret_cast<RtslBvhNode *>(nodes);
  const BuildDevice::Address address = device.allocate(sizeof build, "building the tree");
  device.upload(address, &build, sizeof build);
  device.run(BuildStep::MoveNode, address, count, firstNode, firstItem);
  device.release(address);
}

std::size_t clusterTreeScratch(std::uint32_t items) {
  TreeBuild build{};
  build.count = items;
  Block block;
  placeArrays(build, block);
  return block.size();
}

} // namespace rtsl::runtime
