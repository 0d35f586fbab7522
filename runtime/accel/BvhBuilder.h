//===- BvhBuilder.h - the trees of a scene for the device traversal -------===//
//
// The same scene gives the same trees, on every machine and any number of threads.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/accel/TreeKind.h"
#include "runtime/device/ray/Launch.h"
#include "runtime/device/trees/Items.h"
#include "runtime/scene/Scene.h"

#include <vector>

namespace rtsl::runtime {

struct Bvh {
  std::vector<RtslBvhNode> nodes; // the root is node 0
  std::vector<RtslTreeItem> items;
  // by mesh, then by object with several primitives: the root of its tree; empty if no instance has
  // a transform
  std::vector<std::uint32_t> meshTrees;
  float cost = 0; // of the tree of the world (WideTree::cost)

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
Bvh buildBvh(const std::vector<BvhItem> &items, unsigned threads = 0,
             TreeKind kind = TreeKind::Good);

/// The trees of a scene whose pointers are valid here (TreeItems.h).
Bvh buildBvh(const RtslLaunch &launch, unsigned threads = 0, TreeKind kind = TreeKind::Good);
inline Bvh buildBvh(const Scene &scene, unsigned threads = 0, TreeKind kind = TreeKind::Good) {
  return buildBvh(scene.launch(), threads, kind);
}
/// Builds one of these trees.
Bvh buildTree(const device::build::Items &items, unsigned threads, TreeKind kind);

} // namespace rtsl::runtime
