//===- BvhBuilder.h - the trees of a scene for the device traversal -------===//
//
// The same scene gives the same trees, on every machine and any number of threads.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/ray/Abi.h"
#include "runtime/scene/Scene.h"

#include <vector>

namespace rtsl::runtime {

struct Bvh {
  std::vector<RtslBvhNode> nodes; // the root is node 0
  std::vector<RtslTreeItem> items;
  // by mesh, then by object with several primitives: the root of its tree; empty if no instance has
  // a transform
  std::vector<std::uint32_t> meshTrees;

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
  const RtslMesh *mesh = nullptr; // of a triangle, which does not move
};

/// `threads` 0: one per core.
Bvh buildBvh(const std::vector<BvhItem> &items, unsigned threads = 0);

/// The tree of a scene: of triangles and RTSL primitives, and of instances with transforms of
/// meshes and of objects with several primitives, each of which has another tree. Their items have
/// no instance.
Bvh buildBvh(const Scene &scene, unsigned threads = 0);

} // namespace rtsl::runtime
