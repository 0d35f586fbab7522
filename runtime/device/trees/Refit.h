//===- Refit.h - boxes that follow what has moved -------------------------===//
//
// A tree keeps its shape: items get their boxes, and then nodes, from the last level to the first.
// Several trees follow at once, those of meshes beside that of the world, because none reads the
// boxes of another. The functions are steps, as in Sort.h.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/trees/Grid.h"
#include "runtime/device/trees/Sums.h"

namespace rtsl::device::build {

inline bool isInner(const RtslBvhNode &node, unsigned slot) {
  return node.inner >> slot & 1;
}
inline uint32_t childNode(const RtslBvhNode &node, unsigned slot) {
  return node.firstNode + uint32_t(__builtin_popcount(node.inner & ((1u << slot) - 1)));
}
inline uint32_t itemCount(const RtslBvhNode &node, unsigned slot) {
  return isInner(node, slot) ? 0 : uint32_t(__builtin_popcount(node.child[slot] >> 5));
}
inline uint32_t firstItem(const RtslBvhNode &node, unsigned slot) {
  return node.firstItem + (node.child[slot] & 31u);
}

//===----------------------------------------------------------------------===//
// Levels
//===----------------------------------------------------------------------===//

/// Lists the children that are nodes of those from number `first` to `next` - 1 in
/// TreeRefit::levels: the next level, which begins there.
inline void placeInner(const TreeBuild &build, uint32_t thread, uint32_t first, uint32_t next,
                       uint32_t call) {
  const auto node = [&](uint32_t i) -> const RtslBvhNode & {
    return build.nodes[build.refit.levels[first + i]];
  };
  forSumsBefore(
      build, thread, next - first, call,
      [&](uint32_t i) { return uint64_t(__builtin_popcount(node(i).inner)); },
      [&](uint32_t i, uint64_t sum) {
        const auto count = uint32_t(__builtin_popcount(node(i).inner));
        for (uint32_t child = 0; child < count; ++child)
          build.refit.levels[next + uint32_t(sum) + child] = node(i).firstNode + child;
      });
}

//===----------------------------------------------------------------------===//
// Boxes
//===----------------------------------------------------------------------===//

/// An item takes its vertices from the launch, and gets its box.
inline void followItem(const TreeBuild &build, uint32_t i) {
  const RtslLaunch &launch = *build.items.launch;
  RtslTreeItem &item = build.treeItems[i];
  const bool isOfWorld = item.instance != RTSL_NO_HIT;
  const RtslInstance &instance =
      launch.instances[isOfWorld ? item.instance : rangeOf(build.items, i).instance];
  const bool isOnePrimitive = instance.primitive != 0 && instance.boxCount == 0;
  const bool isWhole = isOfWorld && (isOnePrimitive || instance.transform != 0);
  if (item.hasVertices)
    storeVertices(item, launch.meshes[instance.mesh]);
  build.refit.itemBoxes[i] = boxOfPart(launch, instance, isWhole, item.primitive);
}

/// The box of the child in a slot, exactly.
inline RtslBox boxOfChild(const TreeRefit &refit, const RtslBvhNode &node, unsigned slot) {
  if (isInner(node, slot))
    return refit.nodeBoxes[childNode(node, slot)];
  RtslBox box = emptyBox();
  const uint32_t first = firstItem(node, slot), count = itemCount(node, slot);
  for (uint32_t item = first; item < first + count; ++item)
    extend(box, refit.itemBoxes[item]);
  return box;
}

/// A node takes the boxes of its children.
inline void followNode(const TreeBuild &build, uint32_t i, uint32_t first) {
  const uint32_t number = build.refit.levels[first + i];
  RtslBvhNode &node = build.nodes[number];
  RtslBox all = emptyBox();
  for (unsigned slot = 0; slot < width; ++slot)
    if (node.child[slot] != 0)
      extend(all, boxOfChild(build.refit, node, slot));
  build.refit.nodeBoxes[number] = all;
  if (!(all.lower[0] <= all.upper[0])) // an empty tree
    return;
  setGrid(node, all);
  for (unsigned slot = 0; slot < width; ++slot)
    if (node.child[slot] != 0)
      setBox(node, slot, boxOfChild(build.refit, node, slot));
}

//===----------------------------------------------------------------------===//
// Costs
//===----------------------------------------------------------------------===//

/// The box of the child in a slot, as it is on the grid.
inline RtslBox gridBox(const RtslBvhNode &node, unsigned slot) {
  RtslBox box;
  for (int axis = 0; axis < 3; ++axis) {
    const double step = GridStep(node.exponent[axis]).size;
    box.lower[axis] = float(double(node.origin[axis]) + node.lower[axis][slot] * step);
    box.upper[axis] = float(double(node.origin[axis]) + node.upper[axis][slot] * step);
  }
  return box;
}

/// Sums the costs below a node by the surface area heuristic; of a root, for a ray that enters it.
inline void sumCosts(const TreeBuild &build, uint32_t i, uint32_t first) {
  const TreeRefit &refit = build.refit;
  const uint32_t number = refit.levels[first + i];
  const RtslBvhNode &node = build.nodes[number];
  double sum = 0;
  RtslBox all = emptyBox();
  for (unsigned slot = 0; slot < width; ++slot) {
    if (node.child[slot] == 0)
      continue;
    const RtslBox box = gridBox(node, slot);
    const bool isNode = isInner(node, slot);
    sum += double(halfArea(box)) *
           double(isNode ? costOfNode : costOfItem * float(itemCount(node, slot)));
    if (isNode)
      sum += refit.costs[childNode(node, slot)];
    extend(all, box);
  }
  refit.costs[number] = sum;
  if (first + i < refit.trees) {
    const double cost = sum / double(halfArea(all));
    refit.costsOfTrees[i] = cost > 0 && cost < double(infinity) ? cost : 0; // nor NaN
  }
}

} // namespace rtsl::device::build
