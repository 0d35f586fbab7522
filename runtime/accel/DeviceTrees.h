//===- DeviceTrees.h - the trees of a scene, built where it is ------------===//
#pragma once

#include "runtime/accel/TreeItems.h"
#include "runtime/accel/TreeKind.h"
#include "runtime/accel/trees/ClusterTree.h"

#include <cstdint>

namespace rtsl::runtime {

/// RtslLaunch::nodes, treeItems, meshTrees and nodeCount in the memory of a device.
struct DeviceTrees {
  BuildDevice::Address nodes = 0, items = 0, meshTrees = 0; // of meshTrees 0: none
  TreeFigures figures;

  void install(RtslLaunch &launch) const;
};

/// Builds the trees of a scene, in the memory of a device; the arrays are the caller's. The scene
/// is `there` on the device, and its launch with pointers that are valid in this process is `here`.
/// Fast trees of many items are built on the device, others in this process: the device runs steps
/// for each level of a tree, and a small tree has too few items for its threads. `threads` 0: one
/// per core. Throws what the device throws.
DeviceTrees buildTrees(BuildDevice &device, TreeKind kind, const RtslLaunch &here,
                       BuildDevice::Address there, unsigned threads);

} // namespace rtsl::runtime
