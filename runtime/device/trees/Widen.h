//===- Widen.h - from the binary tree to nodes of eight children ----------===//
//
// Level by level from the root, and then all nodes and items at once. The functions are steps, as
// in Sort.h.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/trees/Grid.h"
#include "runtime/device/trees/TreeBuild.h"

namespace rtsl::device::build {

inline Children childrenOfWide(const TreeBuild &build, uint32_t node) {
  if (build.choice(node).isNode)
    return childrenOf(build, node);
  Children children; // the root of a tree of few items, which is a leaf
  children.add(node);
  return children;
}

/// A child of a node: a node in the lower half of the sum, or items in the upper one.
inline uint64_t sizeOfChild(const TreeBuild &build, uint32_t child) {
  const Choice choice = build.choice(child);
  return choice.isNode ? 1 : uint64_t(choice.items) << 32;
}

/// Calls visit(child, slot, what the children before it take) in the order of slots.
template <typename Visit>
void forEachChild(const TreeBuild &build, const WideNode &wide, Visit visit) {
  const Children children = childrenOfWide(build, wide.node);
  uint64_t before = 0;
  for (unsigned slot = 0; slot < width; ++slot)
    for (unsigned i = 0; i < children.count; ++i)
      if (slotOf(wide.slots, i) == slot) {
        visit(children.nodes[i], slot, before);
        before += sizeOfChild(build, children.nodes[i]);
      }
}

inline void startWide(const TreeBuild &build, uint32_t) {
  build.wide[0].node = 2 * build.count - 2;
  build.levels[0] = {0, 1, 0};
}

/// Sums the sizes of the children of a node of a level.
inline void countChildren(const TreeBuild &build, uint32_t i, uint32_t number) {
  const Children children = childrenOfWide(build, build.wide[build.levels[number].first + i].node);
  uint64_t sum = 0;
  for (unsigned child = 0; child < children.count; ++child)
    sum += sizeOfChild(build, children.nodes[child]);
  build.numbers[i] = sum;
}

/// Sets where the children of the same node are. Those of all nodes of the level are the next one.
inline void placeChildren(const TreeBuild &build, uint32_t i, uint32_t number) {
  const Level level = build.levels[number];
  WideNode &wide = build.wide[level.first + i];
  const Children children = childrenOfWide(build, wide.node);
  wide.slots =
      slotsOf(build.boxes[wide.node], children.count, [&](unsigned child) -> const RtslBox & {
        return build.boxes[children.nodes[child]];
      });
  wide.firstNode = level.end + uint32_t(build.numbers[i]);
  wide.firstItem = level.firstItem + uint32_t(build.numbers[i] >> 32);
  uint64_t all = 0;
  forEachChild(build, wide, [&](uint32_t child, unsigned, uint64_t before) {
    if (build.choice(child).isNode)
      build.wide[wide.firstNode + uint32_t(before)].node = child;
    all = before + sizeOfChild(build, child);
  });
  if (level.first + i + 1 == level.end)
    build.levels[number + 1] = {level.end, wide.firstNode + uint32_t(all),
                                wide.firstItem + uint32_t(all >> 32)};
}

/// Writes the items below a node, at most RTSL_MOST_LEAF_ITEMS.
inline void writeContents(const TreeBuild &build, uint32_t node, uint32_t *to) {
  uint32_t open[RTSL_MOST_LEAF_ITEMS], count = 1;
  open[0] = node;
  while (count != 0) {
    const uint32_t next = open[--count];
    if (build.isItem(next)) {
      *to++ = build.itemOf(next);
      continue;
    }
    open[count++] = build.right(next);
    open[count++] = build.left(next);
  }
}

inline void writeNode(const TreeBuild &build, uint32_t i) {
  const WideNode wide = build.wide[i];
  RtslBvhNode node = emptyNode();
  setGrid(node, build.boxes[wide.node]);
  node.firstNode = wide.firstNode;
  node.firstItem = wide.firstItem;
  forEachChild(build, wide, [&](uint32_t child, unsigned slot, uint64_t before) {
    setBox(node, slot, build.boxes[child]);
    const Choice choice = build.choice(child);
    const auto item = uint32_t(before >> 32);
    if (choice.isNode) {
      node.inner |= uint8_t(1u << slot);
      node.child[slot] = uint8_t(RTSL_INNER_CHILD + slot);
    } else {
      node.child[slot] = RTSL_LEAF(item, choice.items);
      writeContents(build, child, build.contents + wide.firstItem + item);
    }
  });
  build.nodes[i] = node;
}

inline void writeItem(const TreeBuild &build, uint32_t i) {
  build.treeItems[i] = treeItem(build.items, build.contents[i]);
}

/// Moves a tree to a place among others.
inline void moveNode(RtslBvhNode &node, uint32_t firstNode, uint32_t firstItem) {
  node.firstNode += firstNode;
  node.firstItem += firstItem;
}

} // namespace rtsl::device::build
