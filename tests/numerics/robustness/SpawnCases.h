//===- SpawnCases.h - triangles to leave, and gaps to cross ---------------===//
#pragma once

#include "Generators.h"
#include "TriangleCases.h"

#include <array>
#include <optional>
#include <string>

namespace rtsl::numerics {

/// Sizes from a millionth of the distance to the world's centre to as large as that.
Triangle triangleToLeave(Random &random);
/// A ray towards a point of it, from as far as 2^lowest to 2^highest of its largest coordinate.
Ray rayTowards(Random &random, const Triangle &triangle, int lowest, int highest);

using Vector = std::array<double, 3>; // 2^29 times as exact as what is measured

/// The plane of a triangle: `normal` has length 1. A sliver has no good one.
struct Plane {
  device::Vec3 base;
  Vector normal;
  bool isGood;

  explicit Plane(const Triangle &triangle);
  double distance(device::Vec3 point) const;
  /// Of the angle between the normal and a direction of any length.
  double cosine(device::Vec3 direction) const;
};

/// Where a ray meets a triangle that is no sliver, in units of its direction; behind its origin
/// too, and nothing outside and near an edge.
std::optional<double> crossing(const Triangle &triangle, device::Vec3 point,
                               device::Vec3 direction);

/// A second triangle at a small distance from one that was hit, and a ray from the hit point
/// through both.
struct Gap {
  Triangle ceiling;
  device::Vec3 point, direction;
  // between the two, along the normal where the ray goes; in the last place of the largest
  // coordinate
  double ulps;

  std::string text() const {
    return "point " + show(point) + ", direction " + show(direction) + ", " + ceiling.text();
  }
};

/// On the given side, 1 or -1, of the plane through `point` of the triangle. Nothing for slivers,
/// and where the ray passes the second triangle near its edges.
std::optional<Gap> gapAbove(Random &random, const Triangle &triangle, device::Vec3 point,
                            float side);

} // namespace rtsl::numerics
