//===- TriangleCases.h - triangles of every bad kind, and their oracle ----===//
#pragma once

#include "Exact.h"
#include "Generators.h"
#include "Worst.h"

#include "runtime/device/ray/Vector.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace rtsl::numerics {

struct Triangle {
  std::array<device::Vec3, 3> v;

  float largestSide() const {
    return std::max(
        {device::largest(v[1] - v[0]), device::largest(v[2] - v[0]), device::largest(v[2] - v[1])});
  }
  float largestCoordinate() const {
    return std::max({device::largest(v[0]), device::largest(v[1]), device::largest(v[2])});
  }
  std::string text() const {
    return "triangle " + show(v[0]) + " " + show(v[1]) + " " + show(v[2]);
  }
};

/// A triangle and a ray that is aimed at it. Weights below `clear` are so near to an edge that hit
/// and miss are both right.
struct TriangleCase {
  Ray ray;
  Triangle triangle;
  double clear;

  std::string text() const { return ray.text() + ", " + triangle.text(); }
};

/// One way in which triangles are hard; `make` gives the case of that number.
struct TriangleKind {
  const char *name, *description;
  TriangleCase (*make)(Random &random, std::uint64_t number);
};
const std::vector<TriangleKind> &triangleKinds();

/// A triangle without area (collinear or duplicate vertices), and a ray towards it.
TriangleCase degenerateTriangle(Random &random, std::uint64_t number);

/// The query: a ray does not hit what lies behind its origin.
enum class Asked : std::uint8_t { Line, Ray };

/// Judges where it was said to meet the triangle, at `t` or not at all: how far the point at t lies
/// from the triangle's plane, in rounding units of the largest difference between a vertex and the
/// origin of the ray. A clear hit that is missed is infinitely wrong, and so is a hit clearly
/// outside; near edges either answer is right.
void judgeTriangle(const TriangleCase &given, Asked asked, std::optional<float> t, Worst &worst);

/// The distance of a point from the triangle's plane, in rounding units of the triangle's largest
/// coordinate.
double pointOffPlane(const Triangle &triangle, device::Vec3 point);

/// The unit of judgeTriangle.
constexpr const char *planeUnits = "off the plane, rounding units of the farthest vertex";

} // namespace rtsl::numerics
