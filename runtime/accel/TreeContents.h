//===- TreeContents.h - what the trees of a scene contain -----------------===//
#pragma once

#include "runtime/device/ray/Launch.h"

#include <cstdint>
#include <vector>

namespace rtsl::runtime {

/// What the trees of a scene contain of an instance, except positions. If it is the same for all
/// instances of two scenes, trees of one can be refitted to the other (Refit.h).
struct InstanceContents {
  static constexpr std::uint32_t none = ~0u;

  std::uint32_t items;    // its triangles, or primitives of an object that may have several; or 0
  std::uint32_t mesh;     // its number; none: the instance is of a primitive
  std::uint32_t tree;     // device::treeNumber; none: its items are in the tree of the world
  bool hasTransform;      // its item in the tree of the world is its box
  bool hasMovingVertices; // of a mesh with several keys
};

bool operator==(const InstanceContents &a, const InstanceContents &b);

/// The contents by instance. The pointers of the launch must be valid here.
std::vector<InstanceContents> treeContents(const RtslLaunch &launch);

} // namespace rtsl::runtime
