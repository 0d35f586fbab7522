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
  uint32_t isNode : 1;  // if it is one subtree: a node, not a leaf
  uint32_t items : 7;   // below it; mostCounted or more
  uint32_t splits : 21; // ofLeft of 2 to 8, three bits each

  /// Of up to j subtrees, j at least 2: how many are below the left child; 0: as for j - 1. For
  /// j = width they are the children of the node itself.
  unsigned ofLeft(unsigned j) const { return splits >> (3 * (j - 2)) & 7; }
  /// How many subtrees are best if up to j are allowed.
  unsigned best(unsigned j) const {
    const uint32_t upToJ = splits & ((1u << (3 * (j - 1))) - 1);
    return upToJ == 0 ? 1 : unsigned(31 - __builtin_clz(upToJ)) / 3 + 2;
  }
};
constexpr uint32_t mostCounted = 100;

/// A node of the binary tree, in one load of a GPU. A leaf has `splits` of 0, and no children.
struct alignas(16) BinaryNode {
  Choice choice;
  uint32_t left, right;
};

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
  unsigned ofLeft[width + 1];
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
    ofLeft[j] = best;
    split[j] = least;
  }
  const float asLeaf = area * float(items) * costOfItem, asNode = area * costOfNode + split[width];
  choice.isNode = items > mostInLeaf || asNode < asLeaf;
  choice.items = items < mostCounted ? items : mostCounted;
  uint32_t splits = ofLeft[width] << (3 * (width - 2));
  Costs costs;
  costs.of[0] = 0;
  costs.of[1] = choice.isNode ? asNode : asLeaf;
#ifdef __clang__
#pragma clang loop unroll(full)
#endif
  for (unsigned j = 2; j < width; ++j) {
    const bool isBetter = split[j] < costs.of[j - 1];
    costs.of[j] = isBetter ? split[j] : costs.of[j - 1];
    splits |= (isBetter ? ofLeft[j] : 0) << (3 * (j - 2));
  }
  choice.splits = splits;
  return costs;
}

/// Calls visit(child, choice) for the children of a node of the wide tree, from left to right.
/// `tree` has at(node), a BinaryNode. If that is a leaf, as the root of a tree of few items may be,
/// it is the only child.
template <typename Tree, typename Visit>
void forEachSubtree(const Tree &tree, uint32_t root, Visit visit) {
  uint32_t nodes[width], counts = tree.at(root).choice.isNode ? width : 1; // four bits for each
  nodes[0] = root;
  for (uint32_t open = 1; open != 0;) {
    const uint32_t number = nodes[--open];
    const BinaryNode node = tree.at(number);
    const uint32_t count = node.choice.best(counts & 0xf);
    counts >>= 4;
    if (count == 1) {
      visit(number, node.choice);
      continue;
    }
    const uint32_t ofLeft = node.choice.ofLeft(count);
    nodes[open++] = node.right;
    nodes[open++] = node.left;
    counts = counts << 8 | (count - ofLeft) << 4 | ofLeft;
  }
}

/// Nodes of the binary tree, and the choices for them.
struct Children {
  uint32_t count = 0, nodes[width];
  Choice choices[width];

  Children() = default;
  /// Those of a node of the wide tree, from left to right.
  template <typename Tree>
  Children(const Tree &tree, uint32_t root) {
    forEachSubtree(tree, root, [&](uint32_t node, Choice choice) { add(node, choice); });
  }
  void add(uint32_t node, Choice choice) {
    nodes[count] = node;
    choices[count++] = choice;
  }
};

/// What is gained if a child has this slot.
struct SlotGain {
  float gain;
  unsigned slot;
};

/// The best of the slots that are not taken, whose bits are set in `taken`; the first of equal
/// ones. `offset` is how much further along each axis a box is from the lower end of its node's box
/// than from the upper one.
inline SlotGain bestSlot(const float (&offset)[3], uint32_t taken) {
  SlotGain best = {0, width};
#ifdef __clang__
#pragma clang loop unroll(full)
#endif
  for (unsigned slot = 0; slot < width; ++slot) {
    const float gain = (slot & 1 ? offset[0] : -offset[0]) + (slot & 2 ? offset[1] : -offset[1]) +
                       (slot & 4 ? offset[2] : -offset[2]);
    if (!(taken >> slot & 1) && (best.slot == width || gain > best.gain))
      best = {gain, slot};
  }
  return best;
}

/// The slot of each child, four bits each. Slot s is for the child furthest in the direction
/// (x, y, z), where bit 0, 1, 2 of s tells whether x, y, z is 1 or -1. So for rays of any octant
/// the order of slots, with the bits of the octant flipped, is mostly from front to back. Greedy:
/// the child and slot with the largest gain come first. `boxOf(i)` is the box of child i, and `all`
/// that of the node. On a GPU all gains are in registers, so no loop over children ends early.
template <typename BoxOf>
[[gnu::always_inline]] inline uint32_t slotsOf(const RtslBox &all, uint32_t count, BoxOf boxOf) {
  float offsets[width][3];
  SlotGain best[width]; // of each child
#ifdef __clang__
#pragma clang loop unroll(full)
#endif
  for (unsigned child = 0; child < width; ++child) {
    if (child >= count)
      continue;
    const RtslBox &box = boxOf(child);
    for (int axis = 0; axis < 3; ++axis)
      offsets[child][axis] =
          (box.lower[axis] - all.lower[axis]) - (all.upper[axis] - box.upper[axis]);
    best[child] = bestSlot(offsets[child], 0);
  }
  uint32_t slots = 0, placed = 0, taken = 0; // the last two: bits of children, and of slots
  for (unsigned step = 0; step < count; ++step) {
    unsigned next = width;
    SlotGain nextGain = {0, 0};
#ifdef __clang__
#pragma clang loop unroll(full)
#endif
    for (unsigned child = 0; child < width; ++child) {
      if (child >= count || placed >> child & 1)
        continue;
      if (taken >> best[child].slot & 1)
        best[child] = bestSlot(offsets[child], taken);
      if (next == width || best[child].gain > nextGain.gain) {
        next = child;
        nextGain = best[child];
      }
    }
    slots |= nextGain.slot << (4 * next);
    placed |= 1u << next;
    taken |= 1u << nextGain.slot;
  }
  return slots;
}

/// Calls visit(child, slot) in the order of slots, for slots of slotsOf.
template <typename Visit>
void forEachInOrder(uint32_t slots, uint32_t count, Visit visit) {
  uint32_t bySlot = 0xffffffff; // four bits for each slot: its child
  for (unsigned child = 0; child < count; ++child)
    bySlot ^= (child ^ 0xf) << (4 * (slots >> (4 * child) & 0xf));
  for (unsigned slot = 0; slot < width; ++slot)
    if (const unsigned child = bySlot >> (4 * slot) & 0xf; child != 0xf)
      visit(child, slot);
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
