#include "runtime/accel/DeviceTrees.h"

#include "runtime/accel/BvhBuilder.h"
#include "runtime/device/trees/Widen.h"
#include "support/Clock.h"

namespace rtsl::runtime {

namespace {

/// Fast trees of fewer items are built in this process.
constexpr std::uint32_t fewItems = 4096;

/// One of the trees.
struct Piece {
  Bvh here;          // if it was built in this process
  ClusterTree there; // otherwise
  bool isHere = false;

  std::uint32_t nodeCount() const {
    return isHere ? std::uint32_t(here.nodes.size()) : there.nodeCount;
  }
  std::uint32_t itemCount() const {
    return isHere ? std::uint32_t(here.items.size()) : there.itemCount;
  }
  float cost() const { return isHere ? here.cost : there.cost; }
};

class Trees {
public:
  Trees(BuildDevice &device, TreeKind kind, const RtslLaunch &here, BuildDevice::Address there,
        unsigned threads)
      : device(device), kind(kind), here(here), there(there), threads(threads) {
    made.figures.kind = kind;
  }

  DeviceTrees build() {
    const SceneTrees trees = treesOf(here);
    std::vector<std::uint32_t> roots;
    add(trees.world);
    for (const auto &[number, items] : trees.ofMeshes) {
      roots.resize(number + 1);
      roots[number] = made.figures.nodes;
      add(items);
    }
    made.figures.cost = pieces[0].cost();
    if (pieces.size() == 1 && !pieces[0].isHere) {
      made.nodes = pieces[0].there.nodes;
      made.items = pieces[0].there.items;
    } else {
      join();
    }
    if (!roots.empty())
      made.meshTrees = copied(roots.data(), roots.size() * sizeof roots[0]);
    return made;
  }

private:
  void add(const TreeItems &items) {
    Piece piece;
    piece.isHere = kind == TreeKind::Good || items.count < fewItems;
    if (piece.isHere) {
      piece.here = buildTree(items.of(here), threads, kind);
    } else {
      const BuildDevice::Address ranges =
          copied(items.ranges.data(), items.ranges.size() * sizeof items.ranges[0]);
      piece.there =
          buildClusterTree(device, {reinterpret_cast<const RtslLaunch *>(there),
                                    reinterpret_cast<const device::build::ItemRange *>(ranges),
                                    std::uint32_t(items.ranges.size()), items.count});
      device.release(ranges);
    }
    made.figures.nodes += piece.nodeCount();
    made.figures.items += piece.itemCount();
    pieces.push_back(std::move(piece));
  }

  /// Makes one tree of all.
  void join() {
    made.nodes = device.allocate(made.figures.nodes * sizeof(RtslBvhNode), "the tree");
    made.items = device.allocate(made.figures.items * sizeof(RtslTreeItem), "the tree");
    std::uint32_t nodes = 0, items = 0;
    for (Piece &piece : pieces) {
      const BuildDevice::Address toNodes = made.nodes + nodes * sizeof(RtslBvhNode),
                                 toItems = made.items + items * sizeof(RtslTreeItem);
      if (piece.isHere) {
        for (RtslBvhNode &node : piece.here.nodes)
          device::build::moveNode(node, nodes, items);
        device.upload(toNodes, piece.here.nodes.data(), piece.nodeCount() * sizeof(RtslBvhNode));
        device.upload(toItems, piece.here.items.data(), piece.itemCount() * sizeof(RtslTreeItem));
      } else {
        device.copy(toNodes, piece.there.nodes, piece.nodeCount() * sizeof(RtslBvhNode));
        device.copy(toItems, piece.there.items, piece.itemCount() * sizeof(RtslTreeItem));
        device.release(piece.there.nodes);
        device.release(piece.there.items);
        moveNodes(device, toNodes, piece.nodeCount(), nodes, items);
      }
      nodes += piece.nodeCount();
      items += piece.itemCount();
    }
  }

  BuildDevice::Address copied(const void *from, std::size_t bytes) {
    const BuildDevice::Address address = device.allocate(bytes, "the tree");
    device.upload(address, from, bytes);
    return address;
  }

  BuildDevice &device;
  const TreeKind kind;
  const RtslLaunch &here;
  const BuildDevice::Address there;
  const unsigned threads;
  std::vector<Piece> pieces; // of the world first
  DeviceTrees made;
};

} // namespace

void DeviceTrees::install(RtslLaunch &launch) const {
  launch.nodes = reinterpret_cast<const RtslBvhNode *>(nodes);
  launch.treeItems = reinterpret_cast<const RtslTreeItem *>(items);
  launch.meshTrees = reinterpret_cast<const std::uint32_t *>(meshTrees);
  launch.nodeCount = figures.nodes;
}

DeviceTrees buildTrees(BuildDevice &device, TreeKind kind, const RtslLaunch &here,
                       BuildDevice::Address there, unsigned threads) {
  const Clock::time_point start = Clock::now();
  DeviceTrees made = Trees(device, kind, here, there, threads).build();
  device.wait();
  made.figures.seconds = secondsSince(start);
  return made;
}

} // namespace rtsl::runtime
