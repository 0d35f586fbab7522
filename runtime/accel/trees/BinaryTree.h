//===- BinaryTree.h - a binary tree of boxes ------------------------------===//
//
// Top down by the surface area heuristic over 16 bins (Wald, "On fast Construction of SAH-based
// Bounding Volume Hierarchies", 2007). The same boxes give the same tree, on every machine and
// any number of threads.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/scene/SceneData.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace rtsl::runtime {

/// A box to build a tree of; `number` is the caller's.
struct NumberedBox {
  Bounds bounds; // finite
  std::uint32_t number;
};

struct BinaryTree {
  struct Node {
    Bounds bounds;
    std::uint32_t first, count; // of `boxes`: all below the node
    std::uint32_t children[2];  // of `nodes`; both 0: a leaf

    bool isLeaf() const { return children[1] == 0; }
  };
  std::vector<Node> nodes;        // the root first; empty without boxes
  std::vector<NumberedBox> boxes; // in the order of the leaves
  std::uint32_t mostInLeaf = RTSL_MOST_LEAF_ITEMS;
};

/// No path from the root is longer than device::maxBvhDepth, and no leaf has more than `mostInLeaf`
/// boxes. `threads` 0: one per core; the tree does not depend on their number.
BinaryTree buildBinaryTree(std::vector<NumberedBox> boxes, unsigned threads,
                           std::uint32_t mostInLeaf = RTSL_MOST_LEAF_ITEMS);

/// In a tree of so many boxes, subtrees of up to this size are left to one thread each, whatever
/// the number of threads.
inline std::size_t largestForOneThread(std::size_t boxes) {
  return std::max<std::size_t>(4096, boxes / 256);
}

} // namespace rtsl::runtime
