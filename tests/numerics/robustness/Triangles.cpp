//===- Triangles.cpp - rays and triangles at the end of their tether ------===//
#include "Row.h"
#include "RuntimeTriangle.h"
#include "Timing.h"

#include <cmath>
#include <optional>

namespace rtsl::numerics {

namespace {

using device::TriangleHit;
using device::TriangleRay;
using device::Vec3;

Outcome runKind(const TriangleKind &kind, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  for (std::uint64_t i = 0; i < cases; ++i) {
    const TriangleCase given = kind.make(random, i);
    const auto hit = meet(given.triangle, given.ray.origin, given.ray.direction);
    judgeTriangle(given, Asked::Line, hit ? std::optional(hit->t) : std::nullopt, worst);
  }
  return worst.outcome();
}

/// A closed mesh: an octahedron whose faces were divided, its vertices moved at random. Every line
/// from inside meets it.
std::vector<Triangle> closedMesh(Random &random) {
  const Vec3 axes[6] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  Vec3 corners[6];
  for (int i = 0; i < 6; ++i)
    corners[i] = axes[i] * random.between(0.5f, 2.0f) + random.inBox(0.2f);
  const float scale = std::ldexp(1.0f, random.integer(-20, 20));
  for (Vec3 &corner : corners)
    corner = corner * scale;
  std::vector<Triangle> mesh;
  for (int x : {0, 1})
    for (int y : {2, 3})
      for (int z : {4, 5}) {
        // Each face is split at a point of its own; its edges stay shared.
        const Vec3 a = corners[x], b = corners[y], c = corners[z], middle = (a + b + c) * 0.3f;
        mesh.push_back({{a, b, middle}});
        mesh.push_back({{middle, b, c}});
        mesh.push_back({{a, middle, c}});
      }
  return mesh;
}

/// Rays from inside through vertices and edge points of a closed mesh: the number that meets no
/// triangle.
Outcome runClosedMeshes(std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  constexpr int raysPerMesh = 64;
  std::vector<Triangle> mesh;
  for (std::uint64_t i = 0; i < cases; ++i) {
    if (i % raysPerMesh == 0)
      mesh = closedMesh(random);
    const Triangle &triangle = mesh[random.index(mesh.size())];
    Vec3 target = triangle.v[0];
    if (i % 2) {
      const float along = random.between(0, 1);
      target = triangle.v[0] + (triangle.v[1] - triangle.v[0]) * along;
    }
    const Vec3 origin = triangle.v[2] * random.between(0, 0.2f); // towards a corner, so inside
    const Vec3 direction = target - origin;
    const TriangleRay ray = device::makeTriangleRay(origin, direction);
    int found = 0;
    for (const Triangle &candidate : mesh) {
      TriangleHit hit;
      found +=
          device::intersectTriangle(ray, candidate.v[0], candidate.v[1], candidate.v[2], hit) &&
          hit.t >= 0;
    }
    worst.count(found == 0, [&] { return TriangleCase{{origin, direction}, triangle, 0}.text(); });
  }
  return worst.outcome();
}

/// Triangles without area: a hit is only right where the ray meets the point or the segment that
/// they are; its t must be finite then. Counts answers that are not.
Outcome runDegenerate(std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  for (std::uint64_t i = 0; i < cases; ++i) {
    const TriangleCase given = degenerateTriangle(random, i);
    const auto hit = meet(given.triangle, given.ray.origin, given.ray.direction);
    worst.count(hit && !(std::isfinite(hit->t) && std::isfinite(hit->u) && std::isfinite(hit->v)),
                [&] { return given.text(); });
  }
  return worst.outcome();
}

double nanosecondsATriangle() {
  Random random(1);
  constexpr int count = 256, repeats = 2000;
  std::vector<Triangle> triangles;
  for (int i = 0; i < count; ++i)
    triangles.push_back({{random.inBox(1), random.inBox(1), random.inBox(1)}});
  const TriangleRay ray = device::makeTriangleRay({0, 0, -3}, {0.01f, 0.02f, 1});
  return timeOf(count * repeats, [&] {
    int found = 0;
    for (int repeat = 0; repeat < repeats; ++repeat)
      for (const Triangle &triangle : triangles) {
        TriangleHit hit;
        found += device::intersectTriangle(ray, triangle.v[0], triangle.v[1], triangle.v[2], hit);
      }
    return found;
  });
}

} // namespace

std::vector<Row> triangleRows() {
  std::vector<Row> rows = {
      {"triangles.closedMesh",
       "rays from inside a closed mesh, exactly through its edges and vertices: those that meet "
       "nothing",
       "misses", 10'000'000, runClosedMeshes, nanosecondsATriangle},
      {"triangles.degenerate", "collinear and duplicate vertices: answers that are not finite",
       "answers", 10'000'000, runDegenerate, nanosecondsATriangle},
  };
  for (const TriangleKind &kind : triangleKinds())
    rows.push_back(
        {std::string("triangles.") + kind.name, kind.description, planeUnits, 200'000,
         [&kind](std::uint64_t cases, std::uint32_t seed) { return runKind(kind, cases, seed); },
         nanosecondsATriangle});
  return rows;
}

} // namespace rtsl::numerics
