#include "runtime/accel/BvhBuilder.h"

#include "runtime/device/ray/Box.h"
#include "runtime/device/traverse/Bvh.h"
#include "runtime/device/traverse/Traverse.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace rtsl::runtime {

namespace {

constexpr unsigned binCount = 16;
constexpr std::size_t largestLeaf = 4;
// In units of one item's test.
constexpr float costOfNode = 1.0f;

Bounds emptyBounds() {
  constexpr float inf = std::numeric_limits<float>::infinity();
  return {{inf, inf, inf}, {-inf, -inf, -inf}};
}

void extend(Bounds &bounds, const Bounds &by) {
  for (int i = 0; i < 3; ++i) {
    bounds.lower[i] = std::min(bounds.lower[i], by.lower[i]);
    bounds.upper[i] = std::max(bounds.upper[i], by.upper[i]);
  }
}

float halfArea(const Bounds &bounds) {
  float x = bounds.upper[0] - bounds.lower[0], y = bounds.upper[1] - bounds.lower[1],
        z = bounds.upper[2] - bounds.lower[2];
  return x < 0 ? 0 : x * y + y * z + z * x;
}

/// Twice the centre; used only for comparisons.
float centre(const BvhItem &item, int axis) {
  return item.bounds.lower[axis] + item.bounds.upper[axis];
}

unsigned ceilLog2(std::size_t n) {
  unsigned bits = 0;
  while ((std::size_t(1) << bits) < n)
    ++bits;
  return bits;
}

using Iterator = std::vector<BvhItem>::iterator;

struct Split {
  float cost = std::numeric_limits<float>::infinity();
  int axis = -1;
  unsigned bin = 0; // items in lower bins go left
  float first = 0, scale = 0;
};

unsigned binOf(float centre, float first, float scale) {
  return std::min(unsigned((centre - first) * scale), binCount - 1);
}

Split bestSplit(Iterator begin, Iterator end, const Bounds &all) {
  Split best;
  float rootArea = halfArea(all);
  for (int axis = 0; axis < 3; ++axis) {
    float first = std::numeric_limits<float>::infinity(), last = -first;
    for (Iterator item = begin; item != end; ++item) {
      first = std::min(first, centre(*item, axis));
      last = std::max(last, centre(*item, axis));
    }
    float scale = binCount / (last - first);
    if (!(last > first) || !std::isfinite(scale))
      continue;
    Bounds bounds[binCount];
    std::size_t counts[binCount] = {};
    std::fill_n(bounds, binCount, emptyBounds());
    for (Iterator item = begin; item != end; ++item) {
      unsigned bin = binOf(centre(*item, axis), first, scale);
      extend(bounds[bin], item->bounds);
      ++counts[bin];
    }
    float costRight[binCount];
    Bounds sweep = emptyBounds();
    std::size_t count = 0;
    for (unsigned i = binCount; i-- > 1;) {
      extend(sweep, bounds[i]);
      count += counts[i];
      costRight[i] =
          count ? float(count) * halfArea(sweep) : std::numeric_limits<float>::infinity();
    }
    sweep = emptyBounds();
    count = 0;
    for (unsigned i = 1; i < binCount; ++i) {
      extend(sweep, bounds[i - 1]);
      count += counts[i - 1];
      if (count == 0)
        continue;
      float cost = costOfNode + (float(count) * halfArea(sweep) + costRight[i]) / rootArea;
      if (cost < best.cost)
        best = {cost, axis, i, first, scale};
    }
  }
  return best;
}

class Builder {
public:
  explicit Builder(std::vector<BvhItem> items) : items(std::move(items)) {}

  Bvh build() {
    bvh.rootIsLeaf = items.size() <= largestLeaf;
    if (!bvh.rootIsLeaf)
      inner(items.begin(), items.end(), allBounds(items.begin(), items.end()), 0);
    for (const BvhItem &item : items)
      bvh.items.push_back(item.item);
    bvh.rootItems = bvh.rootIsLeaf ? std::uint32_t(items.size()) : 0;
    return std::move(bvh);
  }

private:
  static Bounds allBounds(Iterator begin, Iterator end) {
    Bounds all = emptyBounds();
    for (Iterator item = begin; item != end; ++item)
      extend(all, item->bounds);
    return all;
  }

  /// Builds a node of at least two items; returns its index.
  std::int32_t inner(Iterator begin, Iterator end, const Bounds &all, unsigned depth) {
    std::int32_t index = std::int32_t(bvh.nodes.size());
    bvh.nodes.emplace_back();
    Iterator middle = divide(begin, end, all, depth);
    child(index, 0, begin, middle, depth + 1);
    child(index, 1, middle, end, depth + 1);
    return index;
  }

  /// Partitions the items into left and right, both not empty.
  Iterator divide(Iterator begin, Iterator end, const Bounds &all, unsigned depth) {
    std::size_t count = std::size_t(end - begin);
    // Halving needs ceil(log2(count)) levels: from here on the depth permits only even splits.
    bool mustHalve = depth + ceilLog2(count) + 1 >= unsigned(device::maxBvhDepth);
    if (!mustHalve) {
      Split split = bestSplit(begin, end, all);
      if (split.axis >= 0) {
        Iterator middle = std::stable_partition(begin, end, [&](const BvhItem &item) {
          return binOf(centre(item, split.axis), split.first, split.scale) < split.bin;
        });
        if (middle != begin && middle != end)
          return middle;
      }
    }
    // All centres coincide, or the depth is nearly used up: split at the median of the widest axis.
    int axis = 0;
    for (int i = 1; i < 3; ++i)
      if (all.upper[i] - all.lower[i] > all.upper[axis] - all.lower[axis])
        axis = i;
    Iterator middle = begin + std::ptrdiff_t(count / 2);
    std::nth_element(begin, middle, end, [axis](const BvhItem &a, const BvhItem &b) {
      float ca = centre(a, axis), cb = centre(b, axis);
      if (ca != cb)
        return ca < cb;
      return a.item.instance != b.item.instance ? a.item.instance < b.item.instance
                                                : a.item.primitive < b.item.primitive;
    });
    return middle;
  }

  void child(std::int32_t parent, int side, Iterator begin, Iterator end, unsigned depth) {
    Bounds all = allBounds(begin, end);
    std::size_t count = std::size_t(end - begin);
    std::int32_t target;
    std::uint32_t leafCount = 0;
    if (count <= largestLeaf && (count == 1 || !(bestSplit(begin, end, all).cost < float(count)))) {
      target = ~std::int32_t(begin - items.begin());
      leafCount = std::uint32_t(count);
    } else {
      target = inner(begin, end, all, depth);
    }
    RtslBvhNode &node = bvh.nodes[std::size_t(parent)];
    for (int i = 0; i < 3; ++i) {
      node.lower[side][i] = all.lower[i];
      node.upper[side][i] = all.upper[i];
    }
    node.child[side] = target;
    node.count[side] = leafCount;
  }

  std::vector<BvhItem> items;
  Bvh bvh;
};

} // namespace

void Bvh::install(RtslLaunch &launch) const {
  launch.nodes = nodes.data();
  launch.leafItems = items.data();
  launch.meshTrees = meshTrees.empty() ? nullptr : meshTrees.data();
  launch.rootIsLeaf = rootIsLeaf;
  launch.nodeCount = rootIsLeaf ? rootItems : std::uint32_t(nodes.size());
}

unsigned Bvh::depth() const {
  unsigned deepest = 0;
  std::vector<std::pair<std::int32_t, unsigned>> open;
  if (!rootIsLeaf)
    open.push_back({0, 1});
  while (!open.empty()) {
    auto [node, depth] = open.back();
    open.pop_back();
    deepest = std::max(deepest, depth);
    for (std::int32_t child : nodes[std::size_t(node)].child)
      if (child >= 0)
        open.push_back({child, depth + 1});
  }
  return deepest;
}

Bvh buildBvh(std::vector<BvhItem> items) {
  return Builder(std::move(items)).build();
}

void Bvh::addMeshTree(std::size_t number, const Bvh &tree) {
  if (meshTrees.size() <= number)
    meshTrees.resize(number + 1);
  const auto firstNode = std::int32_t(nodes.size()), firstItem = std::int32_t(items.size());
  meshTrees[number] = tree.rootIsLeaf ? RtslMeshTree{~firstItem, std::uint32_t(tree.items.size())}
                                      : RtslMeshTree{firstNode, 0};
  for (RtslBvhNode node : tree.nodes) {
    for (std::int32_t &child : node.child)
      child = child >= 0 ? child + firstNode : ~(~child + firstItem);
    nodes.push_back(node);
  }
  items.insert(items.end(), tree.items.begin(), tree.items.end());
}

static void addTriangles(const RtslLaunch &launch, const RtslMesh &mesh, std::uint32_t instance,
                         std::vector<BvhItem> &items) {
  for (std::uint32_t t = 0; t < mesh.triangleCount; ++t) {
    const RtslBox box = device::boxOfTriangle(launch, mesh, t);
    BvhItem item{{}, {instance, t}};
    std::copy_n(box.lower, 3, item.bounds.lower);
    std::copy_n(box.upper, 3, item.bounds.upper);
    items.push_back(item);
  }
}

/// The primitives of an object with several.
static void addPrimitives(const RtslLaunch &launch, const RtslInstance &instance,
                          std::uint32_t number, std::vector<BvhItem> &items) {
  for (std::uint32_t i = 0; i < instance.boxCount; ++i) {
    const RtslBox box = device::enlarged(launch.boxes[instance.firstBox + i]);
    BvhItem item{{}, {number, i}};
    std::copy_n(box.lower, 3, item.bounds.lower);
    std::copy_n(box.upper, 3, item.bounds.upper);
    items.push_back(item);
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

Bvh buildBvh(const Scene &scene) {
  RtslLaunch launch = scene.launch();
  std::vector<BvhItem> items;
  std::map<std::size_t, const RtslInstance *> withTree; // by number of the tree
  for (std::uint32_t i = 0; i < launch.instanceCount; ++i) {
    const RtslInstance &instance = launch.instances[i];
    const bool isOnePrimitive = instance.primitive != 0 && instance.boxCount == 0;
    if (device::hasOwnSpace(launch, instance))
      withTree.emplace(device::treeNumber(launch, instance), &instance);
    if (isOnePrimitive || instance.transform != 0)
      items.push_back({scene.instanceBounds(i), {i, 0}});
    else
      addContents(launch, instance, i, items);
  }
  Bvh bvh = buildBvh(std::move(items));
  for (const auto &[number, instance] : withTree) {
    std::vector<BvhItem> inside;
    addContents(launch, *instance, RTSL_NO_HIT, inside);
    bvh.addMeshTree(number, buildBvh(std::move(inside)));
  }
  return bvh;
}

} // namespace rtsl::runtime
