//===- BvhBuilder.h - the binary tree for the device traversal ------------===//
//
// Top down by the surface area heuristic over 16 bins (Wald, "On fast Construction of SAH-based
// Bounding Volume Hierarchies", 2007). The same scene gives the same tree, on every machine.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/ray/Abi.h"
#include "runtime/scene/Scene.h"

#include <vector>

namespace rtsl::runtime {

struct Bvh {
  std::vector<RtslBvhNode> nodes; // the root is node 0, unless rootIsLeaf
  std::vector<RtslLeafItem> items;
  bool rootIsLeaf = false; // there are so few items that there are no nodes

  /// Installs the tree in a launch, which must not outlive it.
  void install(RtslLaunch &launch) const;
  /// The longest path from the root; at most device::maxBvhDepth.
  unsigned depth() const;
};

/// An item for the tree.
struct BvhItem {
  Bounds bounds; // finite
  RtslLeafItem item;
};

Bvh buildBvh(std::vector<BvhItem> items);

/// The tree of all primitives of a scene.
Bvh buildBvh(const Scene &scene);

} // namespace rtsl::runtime
