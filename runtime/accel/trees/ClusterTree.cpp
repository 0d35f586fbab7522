#include "runtime/accel/trees/ClusterTree.h"

#include "runtime/accel/trees/BuildMemory.h"
#include "runtime/device/trees/Clusters.h"
#include "runtime/device/trees/Sort.h"

#include <algorithm>

namespace rtsl::runtime {

using namespace device::build;

namespace {

/// The elements of the largest sum.
std::size_t mostSummed(std::uint32_t items) {
  return std::max<std::size_t>(items, std::size_t(digits) * tileCount(items));
}

/// The arrays of a build, but for those of the tree.
void placeArrays(TreeBuild &build, Block &block, std::uint32_t lanes) {
  const std::size_t n = build.count;
  block.place(build.boxes, 2 * n);
  block.place(build.heights, 2 * n);
  block.place(build.inner, n);
  block.place(build.costs, n);
  block.place(build.centres, n);
  block.place(build.keys[0], n);
  block.place(build.keys[1], n);
  block.place(build.order[0], n);
  block.place(build.order[1], n);
  block.place(build.numbers, mostSummed(build.count));
  placeSums(build, block, mostSummed(build.count), lanes);
  block.place(build.rounds, mostRounds);
  block.place(build.levels, mostHeight + 2);
  block.place(build.clusters[0], n);
  block.place(build.clusters[1], n);
  block.place(build.nearest, n);
  block.place(build.contents, n);
  // Keys are no longer needed then.
  static_assert(sizeof(WideNode) <= 2 * sizeof(std::uint64_t));
  build.wide = reinterpret_cast<WideNode *>(build.keys[0]);
}

class ClusterBuilder {
public:
  ClusterBuilder(BuildDevice &device, const Items &items)
      : device(device), memory(device, buildOf(items), [&](TreeBuild &build, Block &block) {
          placeArrays(build, block, device.lanes());
        }) {
    memory.beginSums(mostSummed(build.count));
  }

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
      memory.sum(BuildStep::SumNumbers, digits * tiles, digits * tiles);
      run(BuildStep::MoveByDigit, tiles * device.lanes(), pass);
    }
  }

  void cluster() {
    // Reading how many are left takes a GPU as long as a round of few clusters.
    const std::uint32_t roundsAtOnce = device.lanes() == 1 ? 1 : 4;
    run(BuildStep::MakeLeaf, build.count);
    run(BuildStep::StartClusters, 1);
    Round round{build.count, false};
    for (std::uint32_t number = 0; round.clusters > 1;) {
      for (const std::uint32_t end = number + roundsAtOnce; number < end; ++number) {
        run(BuildStep::FindNearest, round.clusters, number);
        memory.sum(BuildStep::SumClusters, round.clusters, number);
        run(BuildStep::MoveCluster, round.clusters, number);
      }
      device.download(&round, addressOf(build.rounds + number), sizeof round);
    }
  }

  ClusterTree widen() {
    run(BuildStep::StartWide, 1);
    ClusterTree tree;
    tree.itemCount = build.count;
    tree.cost = cost();
    Level level{0, 1, 0};
    for (std::uint32_t number = 0; level.first < level.end; ++number) {
      const std::uint32_t nodes = level.end - level.first;
      run(BuildStep::CountChildren, nodes, number);
      memory.sum(BuildStep::SumNumbers, nodes, nodes);
      run(BuildStep::PlaceChildren, nodes, number);
      device.download(&level, addressOf(build.levels + number + 1), sizeof level);
    }
    tree.nodeCount = level.end;
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

} // namespace rtsl::runtime
