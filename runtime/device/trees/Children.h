//===- Children.h - the eight children of a node --------------------------===//
//
// Which nodes of a binary tree are joined to one node of up to eight children: for the least cost
// by the surface area heuristic, by dynamic programming (Ylitie, Karras, Laine, "Efficient
// Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", HPG 2017, section 3).
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/trees/Bounds.h"

namespace rtsl::device::build {

constexpr unsigned width = 8;
// Of a ray that enters the box: the time for a node, and for an item.
constexpr float costOfNode = 1.0f, costOfItem = 1.0f;

/// The best ways to replace a node of the binary tree by up to eight subtrees.
struct Choice {
  uint8_t isNode : 1; // if it is one subtree: a node, not a leaf
  uint8_t items : 7;  // below it; mostCounted or more
  /// ofLeft[j - 2], for up to j subtrees: how many of them are below the left child; 0: as for one
  /// less. For j = width they are the children of the node itself.
  uint8_t ofLeft[width - 1];
};
constexpr uint32_t mostCounted = 100;

/// The least cost of up to j subtrees at of[j], for j from 1 to width - 1.
struct Costs {
  float of[width];
};

inline Costs costsOfLeaf(float area, uint32_t items) {
  Costs costs;
  for (float &cost : costs.of)
    cost = area * float(items) * costOfItem;
  return costs;
}

/// Chooses for a node with two children. `area` is that of its box; no more than `mostInLeaf` items
/// become one leaf.
inline Costs choose(Choice &choice, float area, uint32_t items, const Costs &left,
                    const Costs &right, uint32_t mostInLeaf = RTSL_MOST_LEAF_ITEMS) {
  float split[width + 1]; // into exactly j
#ifdef __clang__
#pragma clang loop unroll(full)
#endif
  for (unsigned j = 2; j <= width; ++j) {
    unsigned best = 1;
    float least = left.of[1] + right.of[j - 1];
#ifdef __clang__
#pragma clang loop unroll(full)
#endif
    for (unsigned k = 2; k < j; ++k) {
      const float cost = left.of[k] + right.of[j - k];
      best = cost < least ? k : best;
      least = cost < least ? cost : least;
    }
    choice.ofLeft[j - 2] = uint8_t(best);
    split[j] = least;
  }
  const float asLeaf = area * float(items) * costOfItem, asNode = area * costOfNode + split[width];
  choice.isNode = items > mostInLeaf || asNode < asLeaf;
  choice.items = uint8_t(items < mostCounted ? items : mostCounted);
  Costs costs;
  costs.of[0] = 0;
  costs.of[1] = choice.isNode ? asNode : asLeaf;
#ifdef __clang__
#pragma clang loop unroll(full)
#endif
  for (unsigned j = 2; j < width; ++j) {
    const bool isBetter = split[j] < costs.of[j - 1];
    costs.of[j] = isBetter ? split[j] : costs.of[j - 1];
    if (!isBetter)
      choice.ofLeft[j - 2] = 0;
  }
  return costs;
}

/// Nodes of the binary tree.
struct Children {
  uint32_t count = 0, nodes[width];

  void add(uint32_t node) { nodes[count++] = node; }
};

/// The children of a node of the wide tree, from left to right. `tree` has choice(node), for leaves
/// with zeros in ofLeft, and left(node) and right(node).
template <typename Tree>
Children childrenOf(const Tree &tree, uint32_t root) {
  Children children;
  uint32_t nodes[width], counts[width], open = 1;
  nodes[0] = root;
  counts[0] = width;
  while (open != 0) {
    const uint32_t node = nodes[--open];
    uint32_t count = counts[open];
    const Choice choice = tree.choice(node);
    while (count > 1 && choice.ofLeft[count - 2] == 0)
      --count;
    if (count == 1) {
      children.add(node);
      continue;
    }
    const uint32_t ofLeft = choice.ofLeft[count - 2];
    nodes[open] = tree.right(node);
    counts[open++] = count - ofLeft;
    nodes[open] = tree.left(node);
    counts[open++] = ofLeft;
  }
  return children;
}

/// The slot of each child, four bits each. Slot s is for the child furthest in the direction
/// (x, y, z), where bit 0, 1, 2 of s tells whether x, y, z is 1 or -1. So for rays of any octant
/// the order of slots, with the bits of the octant flipped, is mostly from front to back. Greedy:
/// the child and slot with the largest gain come first. `boxOf(i)` is the box of child i, and `all`
/// that of the node.
template <typename BoxOf>
uint32_t slotsOf(const RtslBox &all, uint32_t count, BoxOf boxOf) {
  float gain[width][width]; // by child and slot
  for (unsigned child = 0; child < count; ++child) {
    const RtslBox box = boxOf(child);
    for (unsigned slot = 0; slot < width; ++slot) {
      gain[child][slot] = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const float offset =
            (box.lower[axis] - all.lower[axis]) - (all.upper[axis] - box.upper[axis]);
        gain[child][slot] += slot >> axis & 1 ? offset : -offset;
      }
    }
  }
  uint32_t slots = 0, placed = 0, taken = 0; // the last two: bits of children, and of slots
  for (unsigned step = 0; step < count; ++step) {
    unsigned bestChild = width, bestSlot = width;
    for (unsigned child = 0; child < count; ++child)
      for (unsigned slot = 0; slot < width; ++slot)
        if (!(placed >> child & 1) && !(taken >> slot & 1) &&
            (bestChild == width || gain[child][slot] > gain[bestChild][bestSlot])) {
          bestChild = child;
          bestSlot = slot;
        }
    slots |= bestSlot << (4 * bestChild);
    placed |= 1u << bestChild;
    taken |= 1u << bestSlot;
  }
  return slots;
}

inline unsigned slotOf(uint32_t slots, unsigned child) {
  return slots >> (4 * child) & 0xf;
}

/// A node without children yet.
inline RtslBvhNode emptyNode() {
  RtslBvhNode node;
  __builtin_memset(&node, 0, sizeof node);
  __builtin_memset(node.exponent, 1, sizeof node.exponent);
  __builtin_memset(node.lower, 255, sizeof node.lower);
  return node;
}

} // namespace rtsl::device::build
