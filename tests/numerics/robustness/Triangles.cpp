//===- Triangles.cpp - rays and triangles at the end of their tether ------===//
#include "Exact.h"
#include "Generators.h"
#include "Row.h"
#include "Timing.h"
#include "Worst.h"

#include "runtime/device/Triangle.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rtsl::numerics {

namespace {

using device::TriangleHit;
using device::TriangleRay;
using device::Vec3;

struct Triangle {
  Vec3 v0, v1, v2;
};

bool intersect(Vec3 origin, Vec3 direction, const Triangle &triangle, TriangleHit &hit) {
  return device::intersectTriangle(device::makeTriangleRay(origin, direction), triangle.v0, triangle.v1, triangle.v2, hit);
}

std::string describe(Vec3 origin, Vec3 direction, const Triangle &triangle) {
  return "ray " + show(origin) + " " + show(direction) + ", triangle " + show(triangle.v0) + " " + show(triangle.v1) + " " + show(triangle.v2);
}

double distanceFromPlane(Vec3 origin, Vec3 direction, const Triangle &triangle, float t, const Rational &truth) {
  if (!std::isfinite(t))
    return std::numeric_limits<double>::infinity();
  const double alongRay = (exact(t) - truth).convert_to<double>();
  double edges[2][3], normal[3], reach = 0, along = 0, length = 0;
  for (int i = 0; i < 3; ++i) {
    edges[0][i] = double(triangle.v1[i]) - triangle.v0[i];
    edges[1][i] = double(triangle.v2[i]) - triangle.v0[i];
    for (const Vec3 &vertex : {triangle.v0, triangle.v1, triangle.v2})
      reach = std::max(reach, std::abs(double(vertex[i]) - origin[i]));
  }
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    normal[i] = edges[0][j] * edges[1][k] - edges[0][k] * edges[1][j];
    along += normal[i] * direction[i];
    length = std::hypot(length, normal[i]);
  }
  return std::abs(alongRay * along / length) / (device::roundingUnit * reach);
}

/// How far the point at the computed t lies from the triangle's plane, in rounding units of the largest difference between a
/// vertex and the origin of the ray. A clear hit that is missed is infinitely wrong, and so is a hit clearly outside; near
/// edges either answer is right.
void judge(Worst &worst, Vec3 origin, Vec3 direction, const Triangle &triangle, double clear) {
  TriangleHit hit;
  const bool isHit = intersect(origin, direction, triangle, hit);
  const ExactHit truth = intersectExactly(origin, direction, triangle.v0, triangle.v1, triangle.v2);
  if (truth.determinant == 0)
    return;
  const double weight = truth.smallestWeight().convert_to<double>();
  if (std::abs(weight) < clear)
    return;
  if (isHit != (weight > 0))
    worst.wrong(describe(origin, direction, triangle));
  else if (isHit)
    worst.add(distanceFromPlane(origin, direction, triangle, hit.t, truth.t), [&] { return describe(origin, direction, triangle); });
}

/// A closed mesh: an octahedron whose faces were divided, its vertices moved at random. Every line from inside meets it.
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
        mesh.push_back({a, b, middle});
        mesh.push_back({middle, b, c});
        mesh.push_back({a, middle, c});
      }
  return mesh;
}

/// Rays from inside through vertices and edge points of a closed mesh: the number that meets no triangle.
Outcome runClosedMeshes(std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  constexpr int raysPerMesh = 64;
  std::vector<Triangle> mesh;
  for (std::uint64_t i = 0; i < cases; ++i) {
    if (i % raysPerMesh == 0)
      mesh = closedMesh(random);
    const Triangle &triangle = mesh[random.index(mesh.size())];
    Vec3 target = triangle.v0;
    if (i % 2) {
      const float along = random.between(0, 1);
      target = triangle.v0 + (triangle.v1 - triangle.v0) * along;
    }
    const Vec3 origin = triangle.v2 * random.between(0, 0.2f); // towards a corner, so inside
    const Vec3 direction = target - origin;
    const TriangleRay ray = device::makeTriangleRay(origin, direction);
    int found = 0;
    for (const Triangle &candidate : mesh) {
      TriangleHit hit;
      found += device::intersectTriangle(ray, candidate.v0, candidate.v1, candidate.v2, hit) && hit.t >= 0;
    }
    worst.count(found == 0, [&] { return describe(origin, direction, triangle); });
  }
  return worst.outcome();
}

Outcome runSlivers(std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  for (std::uint64_t i = 0; i < cases; ++i) {
    // Sides of 11, 9.7 and 1.4, in a random frame.
    const Vec3 x = random.direction(), y = device::normalized(device::cross(x, random.direction())), n = device::cross(x, y);
    constexpr float along = (11.0f * 11.0f + 9.7f * 9.7f - 1.4f * 1.4f) / (2 * 11.0f);
    const float across = std::sqrt(9.7f * 9.7f - along * along);
    const Vec3 origin = random.inBox(100);
    const Triangle triangle = {origin, origin + x * 11.0f, origin + x * along + y * across};
    const float u = random.between(0.05f, 0.9f), v = random.between(0.02f, 0.95f - u);
    const Vec3 target = triangle.v0 * (1 - u - v) + triangle.v1 * u + triangle.v2 * v;
    // Half a degree above the plane.
    const float angle = random.between(0, 6.2831853f), rise = 0.0087266462f;
    const Vec3 direction = x * std::cos(angle) + y * std::sin(angle) + n * rise;
    const float distance = random.between(1, 100);
    judge(worst, target - direction * distance, direction, triangle, 1e-3);
  }
  return worst.outcome();
}

Outcome runScales(std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  for (std::uint64_t i = 0; i < cases; ++i) {
    const float size = i % 2 ? 1e8f : 1e-8f;
    const Triangle triangle = {random.inBox(size), random.inBox(size), random.inBox(size)};
    judge(worst, random.inBox(3 * size), random.direction(), triangle, 1e-2);
    const Vec3 origin = random.inBox(3 * size);
    judge(worst, origin, (triangle.v0 + triangle.v1 + triangle.v2) * (1 / 3.0f) - origin, triangle, 1e-2);
  }
  return worst.outcome();
}

/// Triangles without area: a hit is only right where the ray meets the point or the segment that they are; its t must be
/// finite then. Counts answers that are not.
Outcome runDegenerate(std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  for (std::uint64_t i = 0; i < cases; ++i) {
    const Vec3 a = random.inBox(4), b = random.inBox(4);
    const float half = 0.5f;
    Triangle triangle = {a, b, b};
    switch (i % 4) {
    case 0: break;
    case 1: triangle = {a, a, a}; break;
    case 2: triangle = {a, a + (b - a) * half, b}; break;
    case 3: triangle = {a, {a.x + 1, a.y, a.z}, {a.x + 2, a.y, a.z}}; break;
    }
    const Vec3 origin = random.inBox(8);
    const Vec3 target = i % 3 ? triangle.v0 + (triangle.v2 - triangle.v0) * half : random.inBox(4);
    TriangleHit hit;
    const bool isHit = intersect(origin, target - origin, triangle, hit);
    const bool isFinite = !isHit || (std::isfinite(hit.t) && std::isfinite(hit.u) && std::isfinite(hit.v));
    worst.count(!isFinite, [&] { return describe(origin, target - origin, triangle); });
  }
  return worst.outcome();
}

Outcome runDirections(std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  const float tiny[] = {0.0f, -0.0f, 1e-40f, -1e-40f, 1e-30f, -1e-30f};
  for (std::uint64_t i = 0; i < cases; ++i) {
    float direction[3];
    for (float &component : direction)
      component = tiny[random.index(6)];
    direction[random.index(3)] = random.between(0.5f, 1) * (random.index(2) ? 1 : -1);
    const Vec3 d = device::load(direction);
    const Triangle triangle = {random.inBox(2), random.inBox(2), random.inBox(2)};
    const Vec3 middle = (triangle.v0 + triangle.v1 + triangle.v2) * (1 / 3.0f);
    judge(worst, middle - d * random.between(1, 5), d, triangle, 1e-3);
  }
  return worst.outcome();
}

Outcome runLengths(std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  for (std::uint64_t i = 0; i < cases; ++i) {
    const Triangle triangle = {random.inBox(2), random.inBox(2), random.inBox(2)};
    const Vec3 middle = (triangle.v0 + triangle.v1 + triangle.v2) * (1 / 3.0f), origin = random.inBox(5);
    const float length = i % 2 ? 1e20f : 1e-20f;
    judge(worst, origin, (middle - origin) * length, triangle, 1e-3);
  }
  return worst.outcome();
}

double nanosecondsATriangle() {
  Random random(1);
  constexpr int count = 256, repeats = 2000;
  std::vector<Triangle> triangles;
  for (int i = 0; i < count; ++i)
    triangles.push_back({random.inBox(1), random.inBox(1), random.inBox(1)});
  const TriangleRay ray = device::makeTriangleRay({0, 0, -3}, {0.01f, 0.02f, 1});
  return timeOf(count * repeats, [&] {
    int found = 0;
    for (int repeat = 0; repeat < repeats; ++repeat)
      for (const Triangle &triangle : triangles) {
        TriangleHit hit;
        found += device::intersectTriangle(ray, triangle.v0, triangle.v1, triangle.v2, hit);
      }
    return found;
  });
}

} // namespace

constexpr const char *planeUnits = "off the plane, rounding units of the farthest vertex";

std::vector<Row> triangleRows() {
  return {
      {"triangles.closedMesh", "rays from inside a closed mesh, exactly through its edges and vertices: those that meet nothing", "misses", 10'000'000, runClosedMeshes, nanosecondsATriangle},
      {"triangles.slivers", "sides 11, 9.7 and 1.4, seen at half a degree", planeUnits, 200'000, runSlivers, nanosecondsATriangle},
      {"triangles.scales", "vertices at 1e8 and 1e-8", planeUnits, 200'000, runScales, nanosecondsATriangle},
      {"triangles.degenerate", "collinear and duplicate vertices: answers that are not finite", "answers", 10'000'000, runDegenerate, nanosecondsATriangle},
      {"triangles.directions", "direction components of 0, -0, 1e-40 and 1e-30", planeUnits, 200'000, runDirections, nanosecondsATriangle},
      {"triangles.lengths", "directions of length 1e20 and 1e-20", planeUnits, 200'000, runLengths, nanosecondsATriangle},
  };
}

} // namespace rtsl::numerics
