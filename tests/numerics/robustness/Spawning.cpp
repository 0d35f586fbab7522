//===- Spawning.cpp - rays that leave a surface ---------------------------===//
#include "Generators.h"
#include "Row.h"
#include "Timing.h"
#include "Worst.h"

#include "runtime/device/Spawn.h"
#include "runtime/device/Surface.h"
#include "runtime/device/Triangle.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace rtsl::numerics {

namespace {

using device::Vec3;

/// A triangle as a mesh, which is how surfaces are described.
struct Target {
  std::array<float, 9> positions;
  std::array<std::uint32_t, 3> indices = {0, 1, 2};

  Target(Vec3 v0, Vec3 v1, Vec3 v2) {
    device::store(&positions[0], v0);
    device::store(&positions[3], v1);
    device::store(&positions[6], v2);
  }
  Vec3 vertex(int i) const { return device::load(&positions[3 * std::size_t(i)]); }
  RtslMesh mesh() const {
    RtslMesh mesh{};
    mesh.positions = const_cast<float *>(positions.data());
    mesh.indices = const_cast<std::uint32_t *>(indices.data());
    return mesh;
  }
  bool meet(Vec3 origin, Vec3 direction, device::TriangleHit &hit) const {
    return device::intersectTriangle(device::makeTriangleRay(origin, direction), vertex(0), vertex(1), vertex(2), hit);
  }
  float largestSide() const {
    return std::max({device::largest(vertex(1) - vertex(0)), device::largest(vertex(2) - vertex(0)), device::largest(vertex(2) - vertex(1))});
  }
  float largestCoordinate() const { return std::max({device::largest(vertex(0)), device::largest(vertex(1)), device::largest(vertex(2))}); }
};

/// Sizes from a millionth of the distance to the world's centre to as large as that.
Target randomTarget(Random &random) {
  const float far = std::ldexp(1.0f, random.integer(-10, 10)), size = far * std::ldexp(1.0f, random.integer(-18, 0));
  const Vec3 place = random.inBox(far);
  return {place + random.inBox(size), place + random.inBox(size), place + random.inBox(size)};
}

/// The state of a ray that hit `target`, and what a material sees there. False if it was missed.
bool hitFrom(Random &random, const Target &target, RtslState &state) {
  const float u = random.between(0, 1), v = random.between(0, 1) * (1 - u);
  const Vec3 point = target.vertex(0) * (1 - u - v) + target.vertex(1) * u + target.vertex(2) * v;
  const float distance = target.largestCoordinate() * std::ldexp(1.0f, random.integer(-8, 8));
  const Vec3 origin = point + random.direction() * distance;
  state = {};
  device::store(state.RayOrigin, origin);
  device::store(state.RayDirection, point - origin);
  device::TriangleHit hit;
  if (!target.meet(origin, point - origin, hit) || !(hit.t > 0))
    return false;
  state.HitDistance = hit.t;
  state.u = hit.u;
  state.v = hit.v;
  state.instance = state.primitive = 0;
  device::describeTriangle(state, target.mesh(), RTSL_NEEDS_NORMALS);
  return true;
}

/// Calls `judge(random, target, state, worst)` for random targets that were hit.
template <typename Judge> Outcome forHits(std::uint64_t cases, std::uint32_t seed, Judge judge) {
  Random random(seed);
  Worst worst;
  for (std::uint64_t i = 0; i < cases; ++i) {
    const Target target = randomTarget(random);
    RtslState state;
    if (hitFrom(random, target, state))
      judge(random, target, state, worst);
  }
  return worst.outcome();
}

/// Rays that leave in every direction, along the surface too: those that meet it again.
Outcome runSelfHits(std::uint64_t cases, std::uint32_t seed) {
  return forHits(cases, seed, [](Random &random, const Target &target, const RtslState &state, Worst &worst) {
    const Vec3 point = device::load(state.HitPoint), direction = random.direction() * std::ldexp(1.0f, random.integer(-20, 20));
    const float epsilon = device::spawnEpsilon(state, point, direction);
    device::TriangleHit again;
    const bool isSelfHit = target.meet(point, direction, again) && again.t > epsilon;
    const float cosine = std::fabs(device::dot(device::normalized(direction), device::load(state.GeometricNormal)));
    if (cosine < 2 * device::smallestCosine) // where the bound is given up (runtime/device/Spawn.h)
      return;
    worst.count(isSelfHit, [&] { return "point " + show(point) + ", direction " + show(direction); });
  });
}

/// What a ray that leaves straight up skips, in units in the last place of the largest coordinate, and the hit point's own
/// distance from the plane: a surface nearer than that may be jumped.
Outcome skipUpwards(std::uint64_t cases, std::uint32_t seed, float largestRatio) {
  Random random(seed);
  Worst worst;
  for (std::uint64_t i = 0; i < cases; ++i) {
    const Target target = randomTarget(random);
    RtslState state;
    if (target.largestSide() > largestRatio * target.largestCoordinate() || !hitFrom(random, target, state))
      continue;
    const Vec3 point = device::load(state.HitPoint), normal = device::load(state.GeometricNormal);
    const float epsilon = device::spawnEpsilon(state, point, normal);
    const float ulp = std::ldexp(1.0f, device::exponentOf(target.largestCoordinate()) - 23);
    worst.add((double(epsilon) + std::sqrt(3.0) * device::roundingUnit * target.largestCoordinate()) / ulp, [&] { return "point " + show(point) + ", normal " + show(normal); });
  }
  return worst.outcome();
}

Outcome runGaps(std::uint64_t cases, std::uint32_t seed) { return skipUpwards(cases, seed, 1 / 16.0f); }
Outcome runGapsOfLargeTriangles(std::uint64_t cases, std::uint32_t seed) { return skipUpwards(cases, seed, 2); }

/// How far off its surface a ray that leaves a triangle would still meet it, if its epsilon were 0: what the bound has to
/// cover, in rounding units of the largest coordinate.
Outcome runNeeds(std::uint64_t cases, std::uint32_t seed) {
  return forHits(cases, seed, [](Random &random, const Target &target, const RtslState &state, Worst &worst) {
    const Vec3 point = device::load(state.HitPoint), direction = random.direction();
    device::TriangleHit again;
    if (!target.meet(point, direction, again) || again.t <= 0)
      return;
    const float across = again.t * std::fabs(device::dot(direction, device::load(state.GeometricNormal)));
    worst.add(double(across) / (double(target.largestCoordinate()) * device::roundingUnit), [&] { return "point " + show(point) + ", direction " + show(direction); });
  });
}

/// How far the computed hit point lies from its triangle's plane, in rounding units of the largest coordinate: what the
/// bound in runtime/device/Spawn.h has to cover.
Outcome runHitPoints(std::uint64_t cases, std::uint32_t seed) {
  return forHits(cases, seed, [](Random &, const Target &target, const RtslState &state, Worst &worst) {
    // In double, whose error is 2^-29 of what is measured; slivers have no good normal there either.
    const auto difference = [](Vec3 a, Vec3 b) { return std::array<double, 3>{double(a.x) - b.x, double(a.y) - b.y, double(a.z) - b.z}; };
    const auto e1 = difference(target.vertex(1), target.vertex(0)), e2 = difference(target.vertex(2), target.vertex(0));
    const std::array<double, 3> n = {e1[1] * e2[2] - e1[2] * e2[1], e1[2] * e2[0] - e1[0] * e2[2], e1[0] * e2[1] - e1[1] * e2[0]};
    const double length = std::hypot(n[0], n[1], n[2]);
    if (!(length > 1e-3 * std::hypot(e1[0], e1[1], e1[2]) * std::hypot(e2[0], e2[1], e2[2])))
      return;
    const auto p = difference(device::load(state.HitPoint), target.vertex(0));
    const double distance = std::abs(p[0] * n[0] + p[1] * n[1] + p[2] * n[2]) / length;
    worst.add(distance / (double(target.largestCoordinate()) * device::roundingUnit), [&] { return "point " + show(device::load(state.HitPoint)); });
  });
}

double nanosecondsASpawn() {
  Random random(1);
  RtslState state;
  while (!hitFrom(random, randomTarget(random), state))
    ;
  const Vec3 point = device::load(state.HitPoint);
  constexpr int count = 1'000'000;
  return timeOf(count, [&] {
    float sum = 0;
    for (int i = 0; i < count; ++i)
      sum += device::spawnEpsilon(state, point, {float(i & 255), 1, 2});
    return sum;
  });
}

} // namespace

std::vector<Row> spawnRows() {
  return {
      {"spawning.selfHits", "rays that leave a triangle in any direction but within 2^-11 of its plane: those that meet it again", "hits", 10'000'000, runSelfHits,
       nanosecondsASpawn},
      {"spawning.gaps", "what a ray that leaves a triangle straight up skips; the triangle's sides are at most 1/16 of its coordinates", "ulp of the largest coordinate", 10'000'000, runGaps,
       nanosecondsASpawn},
      {"spawning.gapsOfLargeTriangles", "the same for triangles as large as their coordinates", "ulp of the largest coordinate", 10'000'000, runGapsOfLargeTriangles, nanosecondsASpawn},
      {"spawning.needs", "how far off a triangle a ray that leaves it would meet it again without an epsilon", "rounding units of the largest coordinate", 10'000'000, runNeeds,
       nanosecondsASpawn},
      {"spawning.hitPoints", "the distance of the hit point from its triangle's plane", "rounding units of the largest coordinate", 10'000'000, runHitPoints, nanosecondsASpawn},
  };
}

} // namespace rtsl::numerics
