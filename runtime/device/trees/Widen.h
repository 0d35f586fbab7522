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

/// A child of a node: a node in the lower half of the sum, or items in the upper one.
inline uint64_t sizeOf(Choice child) {
  return child.isNode ? 1 : uint64_t(child.items) << 32;
}

/// Calls visit(child, choice, slot, what the children before it take) in the order of slots, and
/// returns what all take.
template <typename Visit>
uint64_t forEachChild(const Children &children, uint32_t slots, Visit visit) {
  uint64_t before = 0;
  forEachInOrder(slots, children.count, [&](unsigned i, unsigned slot) {
    visit(children.nodes[i], children.choices[i], slot, before);
    before += sizeOf(children.choices[i]);
  });
  return before;
}

inline void startWide(const TreeBuild &build, uint32_t) {
  build.wide[0].node = 2 * build.count - 2;
  build.levels[0] = {0, 1, 0};
}

/// Sums the sizes of the children of a node of a level.
inline void countChildren(const TreeBuild &build, uint32_t i, uint32_t number) {
  uint64_t sum = 0;
  forEachSubtree(build, build.wide[build.levels[number].first + i].node,
                 [&](uint32_t, Choice child) { sum += sizeOf(child); });
  build.numbers[i] = sum;
}

/// Sets where the children of the same node are. Those of all nodes of the level are the next one.
inline void placeChildren(const TreeBuild &build, uint32_t i, uint32_t number) {
  const Level level = build.levels[number];
  WideNode &wide = build.wide[level.first + i];
  const Children children(build, wide.node);
  wide.slots =
      slotsOf(build.boxes[wide.node], children.count, [&](unsigned child) -> const RtslBox & {
        return build.boxes[children.nodes[child]];
      });
  wide.firstNode = level.end + uint32_t(build.numbers[i]);
  wide.firstItem = level.firstItem + uint32_t(build.numbers[i] >> 32);
  const uint64_t all = forEachChild(children, wide.slots,
                                    [&](uint32_t child, Choice choice, unsigned, uint64_t before) {
                                      if (choice.isNode)
                                        build.wide[wide.firstNode + uint32_t(before)].node = child;
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
    const BinaryNode node = build.at(next);
    open[count++] = node.right;
    open[count++] = node.left;
  }
}

inline void writeNode(const TreeBuild &build, uint32_t i) {
  const WideNode wide = build.wide[i];
  RtslBvhNode node = emptyNode();
  setGrid(node, build.boxes[wide.node]);
  node.firstNode = wide.firstNode;
  node.firstItem = wide.firstItem;
  const auto write = [&](uint32_t child, Choice choice, unsigned slot, uint64_t before) {
    setBox(node, slot, build.boxes[child]);
    const auto item = uint32_t(before >> 32);
    if (choice.isNode) {
      node.inner |= uint8_t(1u << slot);
      node.child[slot] = uint8_t(RTSL_INNER_CHILD + slot);
    } else {
      node.child[slot] = RTSL_LEAF(item, choice.items);
      writeContents(build, child, build.contents + wide.firstItem + item);
    }
  };
  forEachChild(Children(build, wide.node), wide.slots, write);
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
