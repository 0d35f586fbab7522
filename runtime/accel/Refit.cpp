#include "runtime/accel/Refit.h"

#include "runtime/device/ray/Box.h"
#include "runtime/device/traverse/Traverse.h"
#include "runtime/device/trees/Bounds.h"
#include "runtime/device/trees/Children.h"
#include "runtime/device/trees/Grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

namespace rtsl::runtime {

using namespace device::build;

namespace {

/// One of the trees of a Bvh: its nodes, of which the root is the first.
struct Part {
  std::uint32_t firstNode, endNode;
  std::uint32_t number; // in RtslLaunch::meshTrees; `ofWorld`: the world
};
constexpr std::uint32_t ofWorld = ~0u;

std::vector<Part> partsOf(const Bvh &bvh) {
  std::vector<Part> parts = {{0, 0, ofWorld}};
  for (std::uint32_t i = 0; i < bvh.meshTrees.size(); ++i)
    if (bvh.meshTrees[i] != 0) // a mesh without a tree of its own
      parts.push_back({bvh.meshTrees[i], 0, i});
  std::sort(parts.begin(), parts.end(),
            [](const Part &a, const Part &b) { return a.firstNode < b.firstNode; });
  for (std::size_t i = 0; i < parts.size(); ++i)
    parts[i].endNode =
        i + 1 < parts.size() ? parts[i + 1].firstNode : std::uint32_t(bvh.nodes.size());
  return parts;
}

bool isInner(const RtslBvhNode &node, unsigned slot) {
  return node.inner >> slot & 1;
}
std::uint32_t childNode(const RtslBvhNode &node, unsigned slot) {
  return node.firstNode + std::uint32_t(__builtin_popcount(node.inner & ((1u << slot) - 1)));
}
std::uint32_t itemCount(const RtslBvhNode &node, unsigned slot) {
  return isInner(node, slot) ? 0 : std::uint32_t(__builtin_popcount(node.child[slot] >> 5));
}
std::uint32_t firstItem(const RtslBvhNode &node, unsigned slot) {
  return node.firstItem + (node.child[slot] & 31u);
}

/// The box of a slot, as it is on the grid.
RtslBox boxOfSlot(const RtslBvhNode &node, unsigned slot) {
  RtslBox box;
  for (int axis = 0; axis < 3; ++axis) {
    const double step = GridStep(node.exponent[axis]).size;
    box.lower[axis] = float(double(node.origin[axis]) + node.lower[axis][slot] * step);
    box.upper[axis] = float(double(node.origin[axis]) + node.upper[axis][slot] * step);
  }
  return box;
}

double costOf(const Bvh &bvh, const Part &part) {
  double sum = 0;
  RtslBox all = emptyBox();
  for (std::uint32_t i = part.firstNode; i < part.endNode; ++i) {
    const RtslBvhNode &node = bvh.nodes[i];
    for (unsigned slot = 0; slot < width; ++slot) {
      if (node.child[slot] == 0)
        continue;
      const RtslBox box = boxOfSlot(node, slot);
      sum += double(halfArea(box)) *
             (isInner(node, slot) ? costOfNode : costOfItem * float(itemCount(node, slot)));
      if (i == part.firstNode)
        extend(all, box);
    }
  }
  const double whole = double(halfArea(all));
  return whole > 0 && std::isfinite(sum / whole) ? sum / whole : 0;
}

/// The first of RtslLaunch::boxes of each object with several primitives.
using FirstBoxes = std::map<std::uint32_t, std::uint32_t>; // by number in RtslLaunch::meshTrees

FirstBoxes firstBoxesOf(const RtslLaunch &launch) {
  FirstBoxes first;
  for (std::uint32_t i = 0; i < launch.instanceCount; ++i)
    if (const RtslInstance &instance = launch.instances[i]; instance.boxCount != 0)
      first.emplace(device::treeNumber(launch, instance), instance.firstBox);
  return first;
}

/// Updates an item, and returns its box.
RtslBox refitItem(RtslTreeItem &item, const RtslLaunch &launch, std::uint32_t tree,
                  const FirstBoxes &firstBoxes) {
  const RtslInstance *instance = tree == ofWorld ? &launch.instances[item.instance] : nullptr;
  if (instance && (instance->transform != 0 || (instance->primitive && !instance->boxCount))) {
    RtslBox box;
    std::copy_n(instance->lower, 3, box.lower);
    std::copy_n(instance->upper, 3, box.upper);
    return box;
  }
  if (instance && instance->primitive)
    return device::enlarged(launch.boxes[instance->firstBox + item.primitive]);
  if (!instance && tree >= launch.meshCount)
    return device::enlarged(launch.boxes[firstBoxes.at(tree) + item.primitive]);
  const RtslMesh &mesh = launch.meshes[instance ? instance->mesh : tree];
  if (item.hasVertices) {
    const device::TriangleVertices p = device::triangleVertices(mesh, item.primitive);
    device::store(item.vertices, p.v0);
    device::store(item.vertices + 3, p.v1);
    device::store(item.vertices + 6, p.v2);
  }
  return device::boxOfTriangle(launch, mesh, item.primitive);
}

/// Updates a tree from the leaves to the root: a child comes after its parent.
void refitPart(Bvh &bvh, const Part &part, const RtslLaunch &launch, const FirstBoxes &firstBoxes) {
  std::vector<RtslBox> boxes(part.endNode - part.firstNode); // of nodes
  for (std::uint32_t i = part.endNode; i-- > part.firstNode;) {
    RtslBvhNode &node = bvh.nodes[i];
    std::array<RtslBox, width> ofSlots;
    RtslBox all = emptyBox();
    for (unsigned slot = 0; slot < width; ++slot) {
      if (node.child[slot] == 0)
        continue;
      RtslBox &box = ofSlots[slot] = emptyBox();
      if (isInner(node, slot))
        box = boxes[childNode(node, slot) - part.firstNode];
      for (std::uint32_t k = 0; k < itemCount(node, slot); ++k)
        extend(box,
               refitItem(bvh.items[firstItem(node, slot) + k], launch, part.number, firstBoxes));
      extend(all, box);
    }
    boxes[i - part.firstNode] = all;
    if (!(all.lower[0] <= all.upper[0])) // an empty tree
      continue;
    setGrid(node, all);
    for (unsigned slot = 0; slot < width; ++slot)
      if (node.child[slot] != 0)
        setBox(node, slot, ofSlots[slot]);
  }
}

/// The bits of a number below 2^10, two zeros between each.
std::uint32_t spread(std::uint32_t bits) {
  bits = (bits | bits << 16) & 0x030000ffu;
  bits = (bits | bits << 8) & 0x0300f00fu;
  bits = (bits | bits << 4) & 0x030c30c3u;
  return (bits | bits << 2) & 0x09249249u;
}

} // namespace

std::vector<double> costsOfTrees(const Bvh &bvh) {
  std::vector<double> costs;
  for (const Part &part : partsOf(bvh))
    costs.push_back(costOf(bvh, part));
  return costs;
}

void refit(Bvh &bvh, const RtslLaunch &launch) {
  const FirstBoxes firstBoxes = firstBoxesOf(launch);
  for (const Part &part : partsOf(bvh))
    refitPart(bvh, part, launch, firstBoxes);
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
