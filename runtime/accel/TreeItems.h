//===- TreeItems.h - which trees a scene has, and their items -------------===//
#pragma once

#include "runtime/device/trees/Items.h"

#include <cstdint>
#include <map>
#include <vector>

namespace rtsl::runtime {

/// What a tree is built of.
struct TreeItems {
  std::vector<device::build::ItemRange> ranges;
  std::uint32_t count = 0;

  /// Nothing, if `items` is 0.
  void add(std::uint32_t items, std::uint32_t instance, std::uint32_t number, bool isWhole);
  /// The items in this process, for a launch whose pointers are valid here.
  device::build::Items of(const RtslLaunch &launch) const {
    return {&launch, ranges.data(), std::uint32_t(ranges.size()), count};
  }
};

/// The trees of a scene: of triangles and RTSL primitives, and of instances with transforms of
/// meshes and of objects with several primitives, each of which has another tree. Their items have
/// no instance.
struct SceneTrees {
  TreeItems world;
  std::map<std::uint32_t, TreeItems> ofMeshes; // by number in RtslLaunch::meshTrees
};
SceneTrees treesOf(const RtslLaunch &launch);
/// The number of items of all trees.
std::uint64_t itemCount(const SceneTrees &trees);

} // namespace rtsl::runtime
