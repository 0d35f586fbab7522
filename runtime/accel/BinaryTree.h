//===- BinaryTree.h - a binary tree of boxes ------------------------------===//
//
// Top down by the surface area heuristic over 16 bins (Wald, "On fast Construction of SAH-based
// Bounding Volume Hierarchies", 2007). The same boxes give the same tree, on every machine and
// any number of threads.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/ray/Abi.h"
#include "runtime/scene/SceneData.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
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
    std::uint32_t children[2];  // of `nodes`; both 0: a leaf, of at most RTSL_MOST_LEAF_ITEMS boxes

    bool isLeaf() const { return children[1] == 0; }
  };
  std::vector<Node> nodes;        // the root first; empty without boxes
  std::vector<NumberedBox> boxes; // in the order of the leaves
};

/// No path from the root is longer than device::maxBvhDepth. `threads` 0: one per core; the tree
/// does not depend on their number.
BinaryTree buildBinaryTree(std::vector<NumberedBox> boxes, unsigned threads);

/// Of a tree of so many boxes: subtrees of up to this many are left to one thread each, whatever
/// the number of threads.
inline std::size_t largestForOneThread(std::size_t boxes) {
  return std::max<std::size_t>(4096, boxes / 256);
}

/// Bounds of nothing, to be extended.
inline Bounds emptyBounds() {
  constexpr float inf = std::numeric_limits<float>::infinity();
  return {{inf, inf, inf}, {-inf, -inf, -inf}};
}

inline void extend(Bounds &bounds, const Bounds &by) {
  for (int i = 0; i < 3; ++i) {
    bounds.lower[i] = std::min(bounds.lower[i], by.lower[i]);
    bounds.upper[i] = std::max(bounds.upper[i], by.upper[i]);
  }
}

/// Half the area of the box's surface.
inline float halfArea(const Bounds &bounds) {
  const float x = bounds.upper[0] - bounds.lower[0], y = bounds.upper[1] - bounds.lower[1],
              z = bounds.upper[2] - bounds.lower[2];
  return x < 0 ? 0 : x * y + y * z + z * x;
}

} // namespace rtsl::runtime
