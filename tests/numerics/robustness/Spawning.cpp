//===- Spawning.cpp - rays that leave a surface ---------------------------===//
#include "MeshOf.h"
#include "Row.h"
#include "RuntimeTriangle.h"
#include "SpawnCases.h"
#include "Timing.h"
#include "tests/unit/runtime/FakeProgram.h"

#include "runtime/device/ray/Spawn.h"
#include "runtime/device/traverse/Surface.h"
#include "runtime/embree/HostScene.h"

#include <cmath>
#include <optional>

namespace rtsl::numerics {

namespace {

using device::Vec3;

/// The state of a ray that hit the triangle, and what a material sees there. False if it was
/// missed.
bool hitFrom(Random &random, const Triangle &target, RtslState &state) {
  const Ray ray = rayTowards(random, target, -8, 8);
  static const RtslLaunch launch{}; // nothing moves, no object holds several primitives
  state = {};
  state.launch = &launch;
  device::store(state.RayOrigin, ray.origin);
  device::store(state.RayDirection, ray.direction);
  const auto hit = meet(target, ray.origin, ray.direction);
  if (!hit || !(hit->t > 0))
    return false;
  state.HitDistance = hit->t;
  state.u = hit->u;
  state.v = hit->v;
  state.instance = state.primitive = 0;
  runtime::Mesh arrays = meshOf({target});
  RtslMesh mesh{};
  mesh.positions = arrays.positions.data();
  mesh.indices = arrays.indices.data();
  device::describeTriangle(state, mesh, device::triangleVertices(mesh, 0), RTSL_NEEDS_NORMALS);
  return true;
}

/// Calls `judge(random, target, state, worst)` for random targets that were hit.
template <typename Judge>
Outcome forHits(std::uint64_t cases, std::uint32_t seed, Judge judge) {
  Random random(seed);
  Worst worst;
  for (std::uint64_t i = 0; i < cases; ++i) {
    const Triangle target = triangleToLeave(random);
    RtslState state;
    if (hitFrom(random, target, state))
      judge(random, target, state, worst);
  }
  return worst.outcome();
}

/// Rays that leave in every direction, along the surface too: those that meet it again.
Outcome runSelfHits(std::uint64_t cases, std::uint32_t seed) {
  return forHits(
      cases, seed,
      [](Random &random, const Triangle &target, const RtslState &state, Worst &worst) {
        const Vec3 point = device::load(state.HitPoint),
                   direction = random.direction() * std::ldexp(1.0f, random.integer(-20, 20));
        const float epsilon = device::spawnEpsilon(state, point, direction);
        const auto again = meet(target, point, direction);
        const bool isSelfHit = again && again->t > epsilon;
        const float cosine = std::fabs(
            device::dot(device::normalized(direction), device::load(state.GeometricNormal)));
        if (cosine <
            2 * device::smallestCosine) // where the bound is given up (runtime/device/ray/Spawn.h)
          return;
        worst.count(isSelfHit,
                    [&] { return "point " + show(point) + ", direction " + show(direction); });
      });
}

/// What a ray that leaves straight up skips, in units in the last place of the largest coordinate,
/// and the hit point's own distance from the plane: a surface nearer than that may be jumped.
Outcome skipUpwards(std::uint64_t cases, std::uint32_t seed, float largestRatio) {
  Random random(seed);
  Worst worst;
  for (std::uint64_t i = 0; i < cases; ++i) {
    const Triangle target = triangleToLeave(random);
    RtslState state;
    if (target.largestSide() > largestRatio * target.largestCoordinate() ||
        !hitFrom(random, target, state))
      continue;
    const Vec3 point = device::load(state.HitPoint), normal = device::load(state.GeometricNormal);
    const float epsilon = device::spawnEpsilon(state, point, normal);
    const float ulp = std::ldexp(1.0f, device::exponentOf(target.largestCoordinate()) - 23);
    worst.add(
        (double(epsilon) + std::sqrt(3.0) * device::roundingUnit * target.largestCoordinate()) /
            ulp,
        [&] { return "point " + show(point) + ", normal " + show(normal); });
  }
  return worst.outcome();
}

Outcome runGaps(std::uint64_t cases, std::uint32_t seed) {
  return skipUpwards(cases, seed, 1 / 16.0f);
}
Outcome runGapsOfLargeTriangles(std::uint64_t cases, std::uint32_t seed) {
  return skipUpwards(cases, seed, 2);
}

/// A gap on either side of the triangle that was hit, and whether the ray that crosses it sees the
/// surface beyond.
struct Crossing {
  Gap gap;
  bool isInFront;
};
std::optional<Crossing> randomCrossing(Random &random, const Triangle &target,
                                       const RtslState &state) {
  const float side = random.integer(0, 1) ? 1 : -1;
  const std::optional<Gap> gap = gapAbove(random, target, device::load(state.HitPoint), side);
  if (!gap)
    return std::nullopt;
  const auto beyond = meet(gap->ceiling, gap->point, gap->direction);
  return Crossing{*gap,
                  beyond && beyond->t > device::spawnEpsilon(state, gap->point, gap->direction)};
}

/// The widest gap that is jumped, though the surface beyond it lies in front of the ray.
Outcome runJumps(std::uint64_t cases, std::uint32_t seed) {
  return forHits(cases, seed,
                 [](Random &random, const Triangle &target, const RtslState &state, Worst &worst) {
                   if (const auto crossing = randomCrossing(random, target, state))
                     worst.add(crossing->isInFront ? 0 : crossing->gap.ulps,
                               [&] { return crossing->gap.text(); });
                 });
}

/// The same through Embree, whose own t decides what is near; and neither the nearest hit nor a
/// shadow is the triangle that the ray leaves.
Outcome runEmbree(std::uint64_t cases, std::uint32_t seed) {
  const auto program = runtime::test::fakeProgram();
  return forHits(cases, seed,
                 [&](Random &random, const Triangle &target, const RtslState &state, Worst &worst) {
                   const auto crossing = randomCrossing(random, target, state);
                   if (!crossing)
                     return;
                   const Gap &gap = crossing->gap;
                   runtime::Scene scene(program);
                   scene.setCamera(scene.addObject(
                       "Camera", runtime::test::members({{"eye", runtime::test::vector(0, 0, 0)},
                                                         {"gaze", runtime::test::vector(0, 0, 1)},
                                                         {"up", runtime::test::vector(0, 1, 0)}})));
                   scene.addMeshInstance(scene.addMesh(meshOf({target, gap.ceiling})),
                                         scene.addObject("Normal", runtime::test::members({})));
                   const runtime::HostScene host(scene, /*useEmbree=*/true, 1);
                   const RtslLaunch launch = scene.launch();

                   RtslState ray{};
                   ray.launch = &launch;
                   ray.rayMask = ~0u;
                   device::store(ray.RayOrigin, gap.point);
                   device::store(ray.RayDirection, gap.direction);
                   ray.Epsilon = device::spawnEpsilon(state, gap.point, gap.direction);
                   ray.HitDistance = device::infinity;
                   ray.instance = ray.primitive = RTSL_NO_HIT;
                   RtslState nearest = ray, shadow = ray;
                   const bool isHit = host.traverse(nearest, 0) == RTSL_HIT,
                              isShadowed = host.traverse(shadow, RTSL_FIRST_HIT) == RTSL_HIT;
                   if ((isHit && nearest.primitive == 0) || (isShadowed && !crossing->isInFront))
                     return worst.wrong(gap.text());
                   worst.add(isHit && isShadowed ? 0 : gap.ulps, [&] { return gap.text(); });
                 });
}

/// How far off its surface a ray that leaves a triangle would still meet it, if its epsilon were 0:
/// what the bound has to cover, in rounding units of the largest coordinate.
Outcome runNeeds(std::uint64_t cases, std::uint32_t seed) {
  return forHits(
      cases, seed,
      [](Random &random, const Triangle &target, const RtslState &state, Worst &worst) {
        const Vec3 point = device::load(state.HitPoint), direction = random.direction();
        const auto again = meet(target, point, direction);
        if (!again || again->t <= 0)
          return;
        const float across =
            again->t * std::fabs(device::dot(direction, device::load(state.GeometricNormal)));
        worst.add(double(across) / (double(target.largestCoordinate()) * device::roundingUnit),
                  [&] { return "point " + show(point) + ", direction " + show(direction); });
      });
}

/// How far the computed hit point lies from its triangle's plane, in rounding units of the largest
/// coordinate: what the bound in runtime/device/ray/Spawn.h has to cover.
Outcome runHitPoints(std::uint64_t cases, std::uint32_t seed) {
  return forHits(cases, seed,
                 [](Random &, const Triangle &target, const RtslState &state, Worst &worst) {
                   const Plane plane(target);
                   if (!plane.isGood)
                     return;
                   const double distance = std::abs(plane.distance(device::load(state.HitPoint)));
                   worst.add(distance / (double(target.largestCoordinate()) * device::roundingUnit),
                             [&] { return "point " + show(device::load(state.HitPoint)); });
                 });
}

double nanosecondsASpawn() {
  Random random(1);
  RtslState state;
  while (!hitFrom(random, triangleToLeave(random), state))
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
      {"spawning.selfHits",
       "rays that leave a triangle in any direction but within 2^-11 of its plane: those that meet "
       "it again",
       "hits", 10'000'000, runSelfHits, nanosecondsASpawn},
      {"spawning.gaps",
       "what a ray that leaves a triangle straight up skips; the triangle's sides are at most 1/16 "
       "of its coordinates",
       "ulp of the largest coordinate", 10'000'000, runGaps, nanosecondsASpawn},
      {"spawning.gapsOfLargeTriangles", "the same for triangles as large as their coordinates",
       "ulp of the largest coordinate", 10'000'000, runGapsOfLargeTriangles, nanosecondsASpawn},
      {"spawning.jumps",
       "gaps between two triangles that a ray from one of them to the other jumps, at any cosine "
       "above 1/8",
       "ulp of the largest coordinate, the widest gap", 10'000'000, runJumps, nanosecondsASpawn},
      {"spawning.embree",
       "the same through Embree, and nearest hits and shadows by the triangle that the ray leaves",
       "ulp of the largest coordinate, the widest gap", 200'000, runEmbree, nanosecondsASpawn},
      {"spawning.needs",
       "how far off a triangle a ray that leaves it would meet it again without an epsilon",
       "rounding units of the largest coordinate", 10'000'000, runNeeds, nanosecondsASpawn},
      {"spawning.hitPoints", "the distance of the hit point from its triangle's plane",
       "rounding units of the largest coordinate", 10'000'000, runHitPoints, nanosecondsASpawn},
  };
}

} // namespace rtsl::numerics
