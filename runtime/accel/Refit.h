//===- Refit.h - trees whose items have moved -----------------------------===//
//
// If only positions and transforms change, the boxes of a tree can follow them: the tree keeps its
// shape. It finds the same hits as a new one, because what a ray hits does not depend on the tree,
// but it is slower the more its items have moved away from their neighbours.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/accel/BvhBuilder.h"
#include "runtime/device/ray/Abi.h"

#include <cstdint>
#include <vector>

namespace rtsl::runtime {

/// A tree is built anew when the expected cost of a ray, by the surface area heuristic, is more
/// than this many times that of the tree as it was built.
constexpr double largestDegradation = 1.5;

/// The expected cost of a ray that enters the root, in boxes and items, of the tree of the world
/// and of each mesh, in the order of their roots.
std::vector<double> costsOfTrees(const Bvh &bvh);

/// Sets the boxes, and the vertices of triangles, of the trees of a scene to those of `launch`,
/// which has the same contents (TreeContents.h) as when they were built; positions, transforms and
/// bounds of primitives may be others.
void refit(Bvh &bvh, const RtslLaunch &launch);

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
