//===- MeshSpawning.cpp - rays that leave triangles, by the whole renderer ===//
#include "MeshOf.h"
#include "RayTarget.h"
#include "Row.h"
#include "SpawnCases.h"
#include "Timing.h"
#include "Worst.h"

#include "runtime/device/ray/Spawn.h"

#include <cmath>
#include <optional>

namespace rtsl::numerics {

namespace {

using device::Vec3;

/// Rays that leave in every direction, along the surface too: those that meet it again.
Outcome runSelfHits(Path path, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  RayTarget &target = changingMesh(path);
  for (std::uint64_t i = 0; i < cases; ++i) {
    const Triangle triangle = triangleToLeave(random);
    const Ray ray = rayTowards(random, triangle, -8, 8);
    const Vec3 onwards = random.direction() * std::ldexp(1.0f, random.integer(-20, 20));
    if (std::fabs(Plane(triangle).cosine(onwards)) < 2 * device::smallestCosine)
      continue; // where the bound is given up (runtime/device/ray/Spawn.h)
    target.replaceBy(meshOf({triangle}));
    if (target.meet(ray.origin, ray.direction))
      worst.count(target.meetsAgain(ray.origin, ray.direction, onwards), [&] {
        return ray.text() + ", " + triangle.text() + ", onwards " + show(onwards);
      });
  }
  return worst.outcome();
}

Outcome runHitPoints(Path path, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  RayTarget &target = changingMesh(path);
  for (std::uint64_t i = 0; i < cases; ++i) {
    const Triangle triangle = triangleToLeave(random);
    const Ray ray = rayTowards(random, triangle, -8, 8);
    target.replaceBy(meshOf({triangle}));
    if (target.meet(ray.origin, ray.direction))
      worst.add(pointOffPlane(triangle, target.hitPoint(ray.origin, ray.direction)),
                [&] { return ray.text() + ", " + triangle.text(); });
  }
  return worst.outcome();
}

/// The widest gap to a second triangle, behind the first one as the eye sees them, that a ray which
/// goes on from the first one jumps.
Outcome runJumps(Path path, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  RayTarget &target = changingMesh(path);
  for (std::uint64_t i = 0; i < cases; ++i) {
    const Triangle triangle = triangleToLeave(random);
    const Ray ray = rayTowards(random, triangle, -8, 0);
    target.replaceBy(meshOf({triangle}));
    if (!target.meet(ray.origin, ray.direction))
      continue;
    const Vec3 point = target.hitPoint(ray.origin, ray.direction);
    const std::optional<Gap> gap =
        gapAbove(random, triangle, point, Plane(triangle).cosine(ray.direction) > 0 ? 1 : -1);
    if (!gap)
      continue;
    target.replaceBy(meshOf({triangle, gap->ceiling}));
    const Vec3 seen = target.hitPoint(ray.origin, ray.direction);
    if (!(seen.x == point.x && seen.y == point.y && seen.z == point.z))
      continue; // from there the second one is the nearer
    worst.add(target.meetsNext(ray.origin, ray.direction, gap->direction) == 1 ? 0 : gap->ulps,
              [&] { return ray.text() + ", " + gap->text(); });
  }
  return worst.outcome();
}

double nanosecondsAWay(Path path) {
  RayTarget &target = changingMesh(path);
  target.replaceBy(meshOf({{{{{-9, -9, 0}, {9, -9, 0}, {0, 9, 0}}}}}));
  constexpr int count = 100'000;
  return timeOf(count, [&] {
    int found = 0;
    for (int i = 0; i < count; ++i)
      found += target.meetsAgain({0.001f * float(i & 255), 0.25f, 5}, {0, 0, -1}, {1, 2, 3});
    return found;
  });
}

} // namespace

std::vector<Row> meshSpawnRows(Path path) {
  const auto row = rowsOf(path, nanosecondsAWay);
  return {
      row("surfaces.selfHits",
          "rendered: rays that leave a triangle in any direction but within 2^-11 of its plane: "
          "those that meet it again",
          "hits", 1'000'000, runSelfHits),
      row("surfaces.hitPoints", "rendered: the distance of the hit point from its triangle's plane",
          "rounding units of the largest coordinate", 500'000, runHitPoints),
      row("surfaces.jumps",
          "rendered: gaps between two triangles that a ray from one of them to the other jumps, at "
          "any cosine above 1/8",
          "ulp of the largest coordinate, the widest gap", 1'000'000, runJumps),
  };
}

} // namespace rtsl::numerics
