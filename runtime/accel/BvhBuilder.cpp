#include "runtime/accel/BvhBuilder.h"

#include "runtime/accel/BinaryTree.h"
#include "runtime/accel/WideTree.h"
#include "runtime/device/ray/Box.h"
#include "runtime/device/traverse/Traverse.h"
#include "support/WorkerThreads.h"

#include <algorithm>
#include <map>

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

Bvh buildBvh(const std::vector<BvhItem> &items, unsigned threads) {
  std::vector<NumberedBox> boxes;
  boxes.reserve(items.size());
  for (const BvhItem &item : items)
    boxes.push_back({item.bounds, std::uint32_t(boxes.size())});
  WideTree tree = widen(buildBinaryTree(std::move(boxes), threads), threads);
  Bvh bvh;
  bvh.nodes = std::move(tree.nodes);
  bvh.items.resize(items.size());
  constexpr std::size_t atOnce = 1 << 14;
  forEachOnThreads(threads, (items.size() + atOnce - 1) / atOnce, [&](std::size_t part) {
    const std::size_t end = std::min(items.size(), (part + 1) * atOnce);
    for (std::size_t i = part * atOnce; i < end; ++i)
      bvh.items[i] = treeItem(items[tree.contents[i]]);
  });
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

static void addTriangles(const RtslLaunch &launch, const RtslMesh &mesh, std::uint32_t instance,
                         std::vector<BvhItem> &items) {
  for (std::uint32_t t = 0; t < mesh.triangleCount; ++t) {
    const Bounds bounds = boundsOf(device::boxOfTriangle(launch, mesh, t));
    items.push_back({bounds, {instance, t}, device::moves(launch, mesh) ? nullptr : &mesh});
  }
}

/// The primitives of an object with several.
static void addPrimitives(const RtslLaunch &launch, const RtslInstance &instance,
                          std::uint32_t number, std::vector<BvhItem> &items) {
  for (std::uint32_t i = 0; i < instance.boxCount; ++i) {
    const RtslBox box = device::enlarged(launch.boxes[instance.firstBox + i]);
    items.push_back({boundsOf(box), {number, i}, nullptr});
  }
}

/// The triangles of a mesh, or the primitives of an object with several, as items of instance
/// `number`.
static void addContents(const RtslLaunch &launch, const RtslInstance &instance,
                        std::uint32_t number, std::vector<BvhItem> &items) {
  if (instance.primitive == 0)
    addTriangles(launch, launch.meshes[instance.mesh], number, items);
  else
    addPrimitives(launch, instance, number, items);
}

Bvh buildBvh(const Scene &scene, unsigned threads) {
  RtslLaunch launch = scene.launch();
  std::vector<BvhItem> items;
  std::map<std::size_t, const RtslInstance *> withTree; // by number of the tree
  for (std::uint32_t i = 0; i < launch.instanceCount; ++i) {
    const RtslInstance &instance = launch.instances[i];
    const bool isOnePrimitive = instance.primitive != 0 && instance.boxCount == 0;
    if (device::hasOwnSpace(launch, instance))
      withTree.emplace(device::treeNumber(launch, instance), &instance);
    if (isOnePrimitive || instance.transform != 0)
      items.push_back({scene.instanceBounds(i), {i, 0}, nullptr});
    else
      addContents(launch, instance, i, items);
  }
  Bvh bvh = buildBvh(items, threads);
  for (const auto &[number, instance] : withTree) {
    std::vector<BvhItem> inside;
    addContents(launch, *instance, RTSL_NO_HIT, inside);
    bvh.addMeshTree(number, buildBvh(inside, threads));
  }
  return bvh;
}

} // namespace rtsl::runtime
