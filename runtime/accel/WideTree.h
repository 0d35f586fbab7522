//===- WideTree.h - the tree of the device traversal ----------------------===//
//
// A binary tree whose nodes are joined to nodes of up to eight children, for the least cost by the
// surface area heuristic, by dynamic programming; and their boxes, rounded outwards to the grid of
// their node (Ylitie, Karras, Laine, "Efficient Incoherent Ray Traversal on GPUs Through Compressed
// Wide BVHs", HPG 2017, sections 3 and 4).
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/accel/BinaryTree.h"
#include "runtime/device/ray/Abi.h"

#include <cstdint>
#include <vector>

namespace rtsl::runtime {

struct WideTree {
  std::vector<RtslBvhNode> nodes;      // the root first; there always is one
  std::vector<std::uint32_t> contents; // NumberedBox::number of the items
};

/// `threads` 0: one per core; the result does not depend on their number.
WideTree widen(const BinaryTree &tree, unsigned threads);

/// Sets the grid of a node for boxes within `all`.
void setGrid(RtslBvhNode &node, const Bounds &all);
/// Sets the box of the child in a slot, within those bounds.
void setBox(RtslBvhNode &node, unsigned slot, const Bounds &box);

} // namespace rtsl::runtime
