//===- WideTree.h - the tree of the device traversal ----------------------===//
//
// A binary tree whose nodes are joined to nodes of up to eight children
// (runtime/device/trees/Children.h); and their boxes, rounded outwards to the grid of their node
// (runtime/device/trees/Grid.h).
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/accel/trees/BinaryTree.h"
#include "runtime/device/ray/Launch.h"

#include <cstdint>
#include <vector>

namespace rtsl::runtime {

struct WideTree {
  std::vector<RtslBvhNode> nodes;      // the root first; there always is one
  std::vector<std::uint32_t> contents; // NumberedBox::number of the items
  // By the surface area heuristic: the nodes and items that a ray is expected to be tested with, of
  // the rays that enter the box of the root. 0: unknown, as areas are 0 or too large.
  float cost = 0;
};

/// `threads` 0: one per core; the result does not depend on their number.
WideTree widen(const BinaryTree &tree, unsigned threads);

} // namespace rtsl::runtime
