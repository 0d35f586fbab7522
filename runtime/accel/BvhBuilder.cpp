#include "runtime/accel/BvhBuilder.h"

#include "runtime/accel/TreeItems.h"
#include "runtime/accel/trees/BinaryTree.h"
#include "runtime/accel/trees/HostBuildDevice.h"
#include "runtime/accel/trees/WideTree.h"
#include "runtime/device/traverse/TestItem.h"
#include "support/Parallel.h"

#include <algorithm>

namespace rtsl::runtime {

namespace {

RtslTreeItem treeItem(const BvhItem &item) {
  RtslTreeItem made{{}, item.item.instance, item.item.primitive, item.mesh != nullptr};
  if (item.mesh) {
    const device::TriangleVertices p = device::triangleVertices(*item.mesh, item.item.primitive);
    device::store(made.vertices, p.v0);
    device::store(made.vertices + 3, p.v1);
    device::store(made.vertices + 6, p.v2);
  }
  return made;
}

} // namespace

void Bvh::install(RtslLaunch &launch) const {
  launch.nodes = nodes.data();
  launch.treeItems = items.data();
  launch.meshTrees = meshTrees.empty() ? nullptr : meshTrees.data();
  launch.nodeCount = std::uint32_t(nodes.size());
}

unsigned Bvh::depth() const {
  unsigned deepest = 0;
  std::vector<std::pair<std::uint32_t, unsigned>> open = {{0, 1}};
  while (!open.empty()) {
    const auto [number, depth] = open.back();
    open.pop_back();
    deepest = std::max(deepest, depth);
    const RtslBvhNode &node = nodes[number];
    for (int i = 0; i < __builtin_popcount(node.inner); ++i)
      open.push_back({node.firstNode + std::uint32_t(i), depth + 1});
  }
  return deepest;
}

namespace {

constexpr std::size_t itemsAtOnce = 1 << 14; // on a thread

/// A tree of so many boxes. `boxOf(i)` is called by several threads.
template <typename BoxOf>
WideTree goodTree(std::size_t count, unsigned threads, BoxOf boxOf) {
  std::vector<NumberedBox> boxes(count);
  forEachInParallel(threads, count, itemsAtOnce,
                    [&](std::size_t i) { boxes[i] = {boxOf(std::uint32_t(i)), std::uint32_t(i)}; });
  return widen(buildBinaryTree(std::move(boxes), threads), threads);
}

/// Copies an array of a device of this process, and frees it.
template <typename Element>
std::vector<Element> take(HostBuildDevice &device, BuildDevice::Address address,
                          std::size_t count) {
  const auto *const elements = reinterpret_cast<const Element *>(address);
  std::vector<Element> taken(elements, elements + count);
  device.release(address);
  return taken;
}

/// The tree of boxes by joining neighbours.
WideTree fastTree(const std::vector<BvhItem> &items, unsigned threads) {
  std::vector<RtslBox> boxes;
  boxes.reserve(items.size());
  for (const BvhItem &item : items)
    boxes.push_back(item.bounds);
  HostBuildDevice device(threads);
  const ClusterTree tree =
      buildClusterTree(device, {nullptr, nullptr, 0, std::uint32_t(items.size())}, boxes.data());
  return {take<RtslBvhNode>(device, tree.nodes, tree.nodeCount),
          take<std::uint32_t>(device, tree.contents, tree.itemCount), tree.cost};
}

} // namespace

Bvh buildTree(const device::build::Items &items, unsigned threads, TreeKind kind) {
  Bvh bvh;
  if (kind == TreeKind::Fast && items.count != 0) {
    HostBuildDevice device(threads);
    const ClusterTree tree = buildClusterTree(device, items);
    bvh.nodes = take<RtslBvhNode>(device, tree.nodes, tree.nodeCount);
    bvh.items = take<RtslTreeItem>(device, tree.items, tree.itemCount);
    bvh.cost = tree.cost;
    return bvh;
  }
  WideTree tree = goodTree(items.count, threads,
                           [&](std::uint32_t i) { return device::build::boxOfItem(items, i); });
  bvh.nodes = std::move(tree.nodes);
  bvh.cost = tree.cost;
  bvh.items.resize(items.count);
  forEachInParallel(threads, items.count, itemsAtOnce, [&](std::size_t i) {
    bvh.items[i] = device::build::treeItem(items, tree.contents[i]);
  });
  return bvh;
}

Bvh buildBvh(const std::vector<BvhItem> &items, unsigned threads, TreeKind kind) {
  WideTree tree = kind == TreeKind::Fast && !items.empty()
                      ? fastTree(items, threads)
                      : goodTree(items.size(), threads, [&](std::uint32_t i) -> const Bounds & {
                          return items[i].bounds;
                        });
  Bvh bvh;
  bvh.nodes = std::move(tree.nodes);
  bvh.cost = tree.cost;
  bvh.items.resize(items.size());
  forEachInParallel(threads, items.size(), itemsAtOnce,
                    [&](std::size_t i) { bvh.items[i] = treeItem(items[tree.contents[i]]); });
  return bvh;
}

void Bvh::addMeshTree(std::size_t number, const Bvh &tree) {
  if (meshTrees.size() <= number)
    meshTrees.resize(number + 1);
  const auto firstNode = std::uint32_t(nodes.size()), firstItem = std::uint32_t(items.size());
  meshTrees[number] = firstNode;
  for (RtslBvhNode node : tree.nodes) {
    node.firstNode += firstNode;
    node.firstItem += firstItem;
    nodes.push_back(node);
  }
  items.insert(items.end(), tree.items.begin(), tree.items.end());
}

Bvh buildBvh(const RtslLaunch &launch, unsigned threads, TreeKind kind) {
  const SceneTrees trees = treesOf(launch);
  Bvh bvh = buildTree(trees.world.of(launch), threads, kind);
  for (const auto &[number, items] : trees.ofMeshes)
    bvh.addMeshTree(number, buildTree(items.of(launch), threads, kind));
  return bvh;
}

} // namespace rtsl::runtime
