//===- MeshTriangles.cpp - hard triangles in meshes, by the whole renderer ===//
#include "MeshOf.h"
#include "RayTarget.h"
#include "Row.h"
#include "Timing.h"
#include "TriangleCases.h"
#include "Worst.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rtsl::numerics {

namespace {

using device::Vec3;

/// The triangle is one of eight, so that there is a tree with its box in it. The others have no
/// area and are never hit.
runtime::Mesh amongPoints(Random &random, const Triangle &triangle) {
  const float around = 4 * triangle.largestCoordinate();
  std::vector<Triangle> triangles;
  for (int i = 0; i < 8; ++i) {
    const Vec3 a = random.inBox(around), b = random.inBox(around);
    triangles.push_back({{a, b, random.integer(0, 1) ? a : b}});
  }
  triangles[random.index(8)] = triangle;
  return meshOf(triangles);
}

Outcome runKind(Path path, const TriangleKind &kind, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed), others(seed + 1);
  Worst worst;
  RayTarget &target = changingMesh(path);
  for (std::uint64_t i = 0; i < cases; ++i) {
    const TriangleCase given = kind.make(random, i);
    target.replaceBy(amongPoints(others, given.triangle));
    judgeTriangle(given, Asked::Ray, target.meet(given.ray.origin, given.ray.direction), worst);
  }
  return worst.outcome();
}

/// The hit points that the material reads.
Outcome runHitPoints(Path path, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed), others(seed + 1);
  Worst worst;
  RayTarget &target = changingMesh(path);
  for (std::uint64_t i = 0; i < cases; ++i) {
    const std::vector<TriangleKind> &kinds = triangleKinds();
    const TriangleCase given = kinds[i % kinds.size()].make(random, i / kinds.size());
    target.replaceBy(amongPoints(others, given.triangle));
    if (target.meet(given.ray.origin, given.ray.direction))
      worst.add(
          pointOffPlane(given.triangle, target.hitPoint(given.ray.origin, given.ray.direction)),
          [&] { return given.text(); });
  }
  return worst.outcome();
}

/// How far the point at t is from the segment, or the point, that a triangle without area is: in
/// rounding units of the largest difference between a vertex and the origin.
double offTheSegment(const TriangleCase &given, float t) {
  if (!std::isfinite(t))
    return std::numeric_limits<double>::infinity();
  const Vec3 from = given.triangle.v[0], to = given.triangle.v[2];
  double side[3], point[3], square = 0, along = 0, reach = 0, distance = 0;
  for (int i = 0; i < 3; ++i) {
    side[i] = double(to[i]) - from[i];
    point[i] = (double(given.ray.origin[i]) - from[i]) + double(t) * given.ray.direction[i];
    square += side[i] * side[i];
    along += side[i] * point[i];
    for (const Vec3 &vertex : given.triangle.v)
      reach = std::max(reach, std::abs(double(vertex[i]) - given.ray.origin[i]));
  }
  const double share = square > 0 ? std::clamp(along / square, 0.0, 1.0) : 0;
  for (int i = 0; i < 3; ++i)
    distance = std::hypot(distance, point[i] - share * side[i]);
  return distance / (device::roundingUnit * reach);
}

Outcome runDegenerate(Path path, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  RayTarget &target = changingMesh(path);
  for (std::uint64_t i = 0; i < cases; ++i) {
    const TriangleCase given = degenerateTriangle(random, i);
    target.replaceBy(
        meshOf({given.triangle, given.triangle, given.triangle, given.triangle, given.triangle}));
    const auto t = target.meet(given.ray.origin, given.ray.direction);
    worst.add(t ? offTheSegment(given, *t) : 0, [&] { return given.text(); });
  }
  return worst.outcome();
}

/// Where the ray meets the triangle's plane, in units of its direction, and the smallest weight
/// there. False if it never does.
bool meetInDouble(const Ray &ray, const Triangle &triangle, double &t, double &weight) {
  double e1[3], e2[3], s[3], d[3];
  for (int i = 0; i < 3; ++i) {
    e1[i] = double(triangle.v[1][i]) - triangle.v[0][i];
    e2[i] = double(triangle.v[2][i]) - triangle.v[0][i];
    s[i] = double(ray.origin[i]) - triangle.v[0][i];
    d[i] = ray.direction[i];
  }
  const auto determinant = [](const double *a, const double *b, const double *c) {
    return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
           a[2] * (b[0] * c[1] - b[1] * c[0]);
  };
  const double whole = determinant(d, e2, e1);
  if (whole == 0)
    return false;
  const double u = determinant(d, e2, s) / whole, v = -determinant(d, e1, s) / whole;
  t = determinant(e2, s, e1) / whole;
  weight = std::min({u, v, 1 - u - v});
  return true;
}

/// As many triangles as there are cases, whose boxes all have their centre in the origin: each has
/// the box's two opposite corners. Rays that pass near the origin meet many; the nearest one is
/// found.
Outcome runEqualCentroids(Path path, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  RayTarget &target = changingMesh(path);
  std::vector<Triangle> triangles;
  for (std::uint64_t i = 0; i < cases; ++i) {
    const Vec3 corner = random.inBox(1);
    const Vec3 third = {corner.x * random.between(-1, 1), corner.y * random.between(-1, 1),
                        corner.z * random.between(-1, 1)};
    triangles.push_back({{corner, corner * -1.0f, third}});
  }
  target.replaceBy(meshOf(triangles));
  for (int look = 0; look < 100; ++look) {
    const Vec3 origin = random.direction() * 3.0f;
    const Ray ray = {origin, random.inBox(0.5f) - origin};
    // In double: only the nearest one is judged, exactly, and not if it is not clear which it is.
    const TriangleCase *nearest = nullptr;
    TriangleCase candidate{ray, {}, 1e-6};
    double best = std::numeric_limits<double>::infinity(), doubtful = best;
    for (const Triangle &triangle : triangles) {
      double t, weight;
      if (!meetInDouble(ray, triangle, t, weight) || t <= 0)
        continue;
      if (weight < candidate.clear) {
        if (weight > -candidate.clear)
          doubtful = std::min(doubtful, t);
      } else if (t < best) {
        best = t;
        candidate.triangle = triangle;
        nearest = &candidate;
      }
    }
    if (nearest && best < doubtful)
      judgeTriangle(*nearest, Asked::Ray, target.meet(ray.origin, ray.direction), worst);
  }
  return worst.outcome();
}

double nanosecondsAMeeting(Path path) {
  RayTarget &target = changingMesh(path);
  Random random(1);
  target.replaceBy(amongPoints(random, {{{{-9, -9, 0}, {9, -9, 0}, {0, 9, 0}}}}));
  return nanosecondsToMeet(target);
}

} // namespace

std::vector<Row> meshTriangleRows(Path path) {
  const auto row = rowsOf(path, nanosecondsAMeeting);
  std::vector<Row> rows;
  for (const TriangleKind &kind : triangleKinds())
    rows.push_back(row(std::string("meshes.") + kind.name,
                       std::string("rendered: ") + kind.description, planeUnits, 200'000,
                       [&kind](Path p, std::uint64_t cases, std::uint32_t seed) {
                         return runKind(p, kind, cases, seed);
                       }));
  rows.push_back(row("meshes.hitPoints",
                     "the hit points of all these: their distance from the triangle's plane",
                     "rounding units of the largest coordinate", 200'000, runHitPoints));
  rows.push_back(row("meshes.degenerate",
                     "five times the same triangle with collinear or duplicate vertices: hits",
                     "off the segment that it is, rounding units of the farthest vertex", 500'000,
                     runDegenerate));
  rows.push_back(
      row("meshes.equalCentroids",
          "a million triangles whose boxes have one centre: the nearest one that 100 rays meet",
          planeUnits, 1'000'000, runEqualCentroids));
  return rows;
}

} // namespace rtsl::numerics
