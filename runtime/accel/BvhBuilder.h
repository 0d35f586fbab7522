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
  // by mesh, then by object with several primitives; empty if no instance has a transform
  std::vector<RtslMeshTree> meshTrees;
  bool rootIsLeaf = false;     // there are so few items that there are no nodes
  std::uint32_t rootItems = 0; // the number of these items, from the first on

  /// Installs the tree in a launch, which must not outlive it.
  void install(RtslLaunch &launch) const;
  /// Appends the tree of a mesh or an object with several primitives.
  void addMeshTree(std::size_t number, const Bvh &tree);
  /// The longest path from the root; at most device::maxBvhDepth.
  unsigned depth() const;
};

/// An item for the tree.
struct BvhItem {
  Bounds bounds; // finite
  RtslLeafItem item;
};

Bvh buildBvh(std::vector<BvhItem> items);

/// The tree of a scene: of triangles and RTSL primitives, and of instances with transforms of
/// meshes and of objects with several primitives, each of which has another tree. Their items have
/// no instance.
Bvh buildBvh(const Scene &scene);

} // namespace rtsl::runtime
