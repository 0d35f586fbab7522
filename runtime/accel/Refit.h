//===- Refit.h - trees whose items have moved -----------------------------===//
//
// If only positions and transforms change, the boxes of a tree can follow them: the tree keeps its
// shape. It finds the same hits as a new one, because what a ray hits does not depend on the tree,
// but it is slower the more its items have moved away from their neighbours. On a CPU and on a GPU
// the same functions (runtime/device/trees/Refit.h) give the same boxes.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/accel/TreeItems.h"
#include "runtime/accel/trees/ClusterTree.h"

#include <cstdint>
#include <vector>

namespace rtsl::runtime {

/// A tree is built anew when the expected cost of a ray, by the surface area heuristic, is more
/// than this many times that of the tree as it was built.
constexpr double largestDegradation = 1.5;

/// The trees of a scene in the memory of a device.
struct TreesThere {
  BuildDevice::Address nodes = 0, items = 0;
  std::uint32_t nodeCount = 0, itemCount = 0;
  std::vector<std::uint32_t> roots; // of the world first, then of meshes as in SceneTrees
};

/// Trees on a device, whose boxes follow what moves. They and the device must outlive it.
class Refit {
public:
  /// `contents`: of a launch with the same contents (TreeContents.h). Throws OutOfMemory, and what
  /// the device throws.
  Refit(BuildDevice &device, TreesThere trees, const SceneTrees &contents);
  ~Refit();
  Refit(const Refit &) = delete;
  Refit &operator=(const Refit &) = delete;

  /// The expected cost of a ray that enters the root, in boxes and items, of each tree.
  std::vector<double> costs();

  /// Sets the boxes, and the vertices of triangles, to those of a launch in the memory of the
  /// device, which has the same contents; positions, transforms and bounds of primitives may be
  /// others. Returns the costs.
  std::vector<double> follow(BuildDevice::Address launch);

private:
  void release();
  device::build::TreeBuild begin() const;
  void findLevels();
  std::vector<double> run(BuildDevice::Address launch);

  BuildDevice &device;
  const TreesThere trees;
  BuildDevice::Address ranges = 0, levels = 0;
  std::uint32_t rangeCount = 0;
  std::vector<std::uint32_t> starts; // of the levels, and their end
};

/// Has one of the trees become too bad?
bool areTooBad(const std::vector<double> &costs, const std::vector<double> &costsWhenBuilt);

/// For trees whose nodes cannot be read, such as Embree's: the cost of a tree over boxes that joins
/// neighbours on a space-filling curve, in the order that the boxes had when they were built.
class BoxOrder {
public:
  explicit BoxOrder(const std::vector<RtslBox> &boxes = {});
  /// The ratio of the cost to what it was, after the boxes have moved; there must be as many as
  /// before. At least 0; 1 if nothing has moved.
  double degradation(const std::vector<RtslBox> &boxes) const;

private:
  double cost(const std::vector<RtslBox> &boxes) const;

  std::vector<std::uint32_t> order;
  double costWhenBuilt = 0;
};

} // namespace rtsl::runtime
