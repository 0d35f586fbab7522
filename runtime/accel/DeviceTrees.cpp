#include "runtime/accel/DeviceTrees.h"

#include "runtime/accel/BvhBuilder.h"
#include "runtime/accel/TreeItems.h"
#include "runtime/device/trees/Widen.h"
#include "support/Clock.h"

#include <utility>

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

/// What was built.
struct Made {
  TreesThere trees;
  BuildDevice::Address meshTrees = 0;
  float cost = 0; // of the tree of the world
};

class Builder {
public:
  Builder(BuildDevice &device, TreeKind kind, const RtslLaunch &here, BuildDevice::Address there,
          unsigned threads)
      : device(device), kind(kind), here(here), there(there), threads(threads) {}

  Made build(const SceneTrees &contents) {
    std::vector<std::uint32_t> meshTrees;
    add(contents.world);
    for (const auto &[number, items] : contents.ofMeshes) {
      meshTrees.resize(number + 1);
      meshTrees[number] = made.trees.nodeCount;
      add(items);
    }
    made.cost = pieces[0].cost();
    if (pieces.size() == 1 && !pieces[0].isHere) {
      made.trees.nodes = pieces[0].there.nodes;
      made.trees.items = pieces[0].there.items;
    } else {
      join();
    }
    if (!meshTrees.empty())
      made.meshTrees = copied(meshTrees.data(), meshTrees.size() * sizeof meshTrees[0]);
    return std::move(made);
  }

private:
  void add(const TreeItems &items) {
    made.trees.roots.push_back(made.trees.nodeCount);
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
    made.trees.nodeCount += piece.nodeCount();
    made.trees.itemCount += piece.itemCount();
    pieces.push_back(std::move(piece));
  }

  /// Makes one tree of all.
  void join() {
    made.trees.nodes = device.allocate(made.trees.nodeCount * sizeof(RtslBvhNode), "the tree");
    made.trees.items = device.allocate(made.trees.itemCount * sizeof(RtslTreeItem), "the tree");
    std::uint32_t nodes = 0, items = 0;
    for (Piece &piece : pieces) {
      const BuildDevice::Address toNodes = made.trees.nodes + nodes * sizeof(RtslBvhNode),
                                 toItems = made.trees.items + items * sizeof(RtslTreeItem);
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
  Made made;
};

} // namespace

DeviceTrees::DeviceTrees(std::unique_ptr<BuildDevice> device) : device(std::move(device)) {}

DeviceTrees::~DeviceTrees() {
  release();
}

void DeviceTrees::release() {
  refitted.reset();
  costsWhenBuilt.clear();
  contents.reset();
  for (BuildDevice::Address *const address : {&trees.nodes, &trees.items, &meshTrees})
    if (const BuildDevice::Address one = std::exchange(*address, 0))
      device->release(one);
}

void DeviceTrees::build(const RtslLaunch &here, BuildDevice::Address there, unsigned threads,
                        std::optional<TreeKind> wanted) {
  release();
  const SceneTrees ofScene = treesOf(here);
  const TreeKind kind = treeKind(wanted, itemCount(ofScene));
  Made made = Builder(*device, kind, here, there, threads).build(ofScene);
  trees = std::move(made.trees);
  meshTrees = made.meshTrees;
  figures = {kind, trees.nodeCount, trees.itemCount, made.cost};
}

/// Returns whether the trees are good enough.
bool DeviceTrees::refit(const RtslLaunch &here, BuildDevice::Address there) {
  if (!refitted) {
    refitted = std::make_unique<Refit>(*device, trees, treesOf(here));
    costsWhenBuilt = refitted->costs();
  }
  figures.isRefitted = !areTooBad(refitted->follow(there), costsWhenBuilt);
  return figures.isRefitted;
}

void DeviceTrees::follow(const RtslLaunch &here, BuildDevice::Address there, unsigned threads,
                         std::optional<TreeKind> kind) {
  const Clock::time_point start = Clock::now();
  std::vector<InstanceContents> ofScene = treeContents(here);
  const bool isSame = std::exchange(contents, std::nullopt) == ofScene;
  if (!isSame || !refit(here, there))
    build(here, there, threads, kind);
  device->wait();
  contents = std::move(ofScene);
  figures.seconds = secondsSince(start);
}

void DeviceTrees::install(RtslLaunch &launch) const {
  launch.nodes = reinterpret_cast<const RtslBvhNode *>(trees.nodes);
  launch.treeItems = reinterpret_cast<const RtslTreeItem *>(trees.items);
  launch.meshTrees = reinterpret_cast<const std::uint32_t *>(meshTrees);
  launch.nodeCount = trees.nodeCount;
}

} // namespace rtsl::runtime
