//===- Spawning.cpp - rays that leave a surface ---------------------------===//
#include "Generators.h"
#include "Row.h"
#include "Timing.h"
#include "Worst.h"
#include "tests/unit/runtime/FakeProgram.h"

#include "runtime/HostScene.h"
#include "runtime/device/Spawn.h"
#include "runtime/device/Surface.h"
#include "runtime/device/Triangle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

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

using Vector = std::array<double, 3>; // 2^29 times as exact as what is measured

Vector difference(Vec3 a, Vec3 b) { return {double(a.x) - b.x, double(a.y) - b.y, double(a.z) - b.z}; }
Vector cross(const Vector &a, const Vector &b) { return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}; }
double dot(const Vector &a, const Vector &b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// The plane of a triangle: `normal` has length 1. A sliver has no good one.
struct Plane {
  Vec3 base;
  Vector normal;
  bool isGood;

  explicit Plane(const Target &target) : base(target.vertex(0)) {
    const Vector e1 = difference(target.vertex(1), base), e2 = difference(target.vertex(2), base);
    normal = cross(e1, e2);
    const double length = std::sqrt(dot(normal, normal));
    isGood = length > 1e-3 * std::sqrt(dot(e1, e1) * dot(e2, e2));
    for (double &component : normal)
      component /= length;
  }
  double distance(Vec3 point) const { return dot(difference(point, base), normal); }
};

/// A second triangle at a small distance from one that was hit, and a ray from the hit point through both.
struct Gap {
  Target ceiling;
  Vec3 point, direction;
  float epsilon;
  double ulps; // between the two, along the normal where the ray goes; in the last place of the largest coordinate

  std::string text() const { return "point " + show(point) + ", direction " + show(direction); }
};

/// Nothing for slivers, and where the ray passes the second triangle near its edges.
std::optional<Gap> randomGap(Random &random, const Target &target, const RtslState &state) {
  const Plane floor(target);
  if (!floor.isGood)
    return std::nullopt;
  const float ulp = std::ldexp(1.0f, device::exponentOf(target.largestCoordinate()) - 23);
  const float side = random.integer(0, 1) ? 1 : -1, height = side * ulp * random.between(0, 24);
  const Vec3 up = {float(floor.normal[0]), float(floor.normal[1]), float(floor.normal[2])};
  const auto above = [&](int i) { return target.vertex(i) + up * height; };
  Gap gap{{above(0), above(1), above(2)}, device::load(state.HitPoint), {}, 0, 0};
  Vec3 direction;
  do
    direction = random.direction();
  while (!(device::dot(direction, up) * side > 0.125f));
  gap.direction = direction * std::ldexp(1.0f, random.integer(-20, 20));
  gap.epsilon = device::spawnEpsilon(state, gap.point, gap.direction);

  const Plane plane(gap.ceiling);
  const Vector along = {gap.direction.x, gap.direction.y, gap.direction.z};
  const double t = -plane.distance(gap.point) / dot(along, plane.normal);
  const Vector crossing = {gap.point.x + t * along[0], gap.point.y + t * along[1], gap.point.z + t * along[2]};
  for (int i = 0; i < 3; ++i) {
    const Vec3 from = gap.ceiling.vertex(i), to = gap.ceiling.vertex((i + 1) % 3), other = gap.ceiling.vertex((i + 2) % 3);
    const Vector inward = cross(plane.normal, difference(to, from));
    const Vector here = {crossing[0] - from.x, crossing[1] - from.y, crossing[2] - from.z};
    if (!(dot(inward, here) > 0.02 * dot(inward, difference(other, from))))
      return std::nullopt;
  }
  const double wide = std::ldexp(1.0, device::exponentOf(std::max(target.largestCoordinate(), gap.ceiling.largestCoordinate())) - 23);
  gap.ulps = (dot(crossing, floor.normal) - (floor.normal[0] * floor.base.x + floor.normal[1] * floor.base.y + floor.normal[2] * floor.base.z)) * side / wide;
  return gap;
}

/// The widest gap that is jumped, though the surface beyond it lies in front of the ray.
Outcome runJumps(std::uint64_t cases, std::uint32_t seed) {
  return forHits(cases, seed, [](Random &random, const Target &target, const RtslState &state, Worst &worst) {
    const std::optional<Gap> gap = randomGap(random, target, state);
    if (!gap)
      return;
    device::TriangleHit hit;
    const bool isSeen = gap->ceiling.meet(gap->point, gap->direction, hit) && hit.t > gap->epsilon;
    worst.add(isSeen ? 0 : gap->ulps, [&] { return gap->text(); });
  });
}

/// The same through Embree, whose own t decides what is near; and neither the nearest hit nor a shadow is the triangle that
/// the ray leaves.
Outcome runEmbree(std::uint64_t cases, std::uint32_t seed) {
  const auto program = runtime::test::fakeProgram();
  return forHits(cases, seed, [&](Random &random, const Target &target, const RtslState &state, Worst &worst) {
    const std::optional<Gap> gap = randomGap(random, target, state);
    if (!gap)
      return;
    runtime::Scene scene(program);
    scene.setCamera(scene.addObject("Camera", runtime::test::members({{"eye", runtime::test::vector(0, 0, 0)}, {"gaze", runtime::test::vector(0, 0, 1)}, {"up", runtime::test::vector(0, 1, 0)}})));
    runtime::Mesh mesh;
    for (const Target *each : {&target, &gap->ceiling})
      mesh.positions.insert(mesh.positions.end(), each->positions.begin(), each->positions.end());
    mesh.indices = {0, 1, 2, 3, 4, 5};
    scene.addMeshInstance(scene.addMesh(std::move(mesh)), scene.addObject("Normal", runtime::test::members({})));
    const runtime::HostScene host(scene, /*useEmbree=*/true, 1);
    const RtslLaunch launch = scene.launch();

    RtslState ray{};
    ray.launch = &launch;
    ray.rayMask = ~0u;
    device::store(ray.RayOrigin, gap->point);
    device::store(ray.RayDirection, gap->direction);
    ray.Epsilon = gap->epsilon;
    ray.HitDistance = device::infinity;
    ray.instance = ray.primitive = RTSL_NO_HIT;
    RtslState nearest = ray, shadow = ray;
    const bool isHit = host.traverse(nearest, 0) == RTSL_HIT, isShadowed = host.traverse(shadow, RTSL_FIRST_HIT) == RTSL_HIT;
    device::TriangleHit beyond;
    const bool isInFront = gap->ceiling.meet(gap->point, gap->direction, beyond) && beyond.t > gap->epsilon;
    if ((isHit && nearest.primitive == 0) || (isShadowed && !isInFront))
      return worst.wrong(gap->text());
    worst.add(isHit && isShadowed ? 0 : gap->ulps, [&] { return gap->text(); });
  });
}

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
    const Plane plane(target);
    if (!plane.isGood)
      return;
    const double distance = std::abs(plane.distance(device::load(state.HitPoint)));
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
      {"spawning.jumps", "gaps between two triangles that a ray from one of them to the other jumps, at any cosine above 1/8", "ulp of the largest coordinate, the widest gap",
       10'000'000, runJumps, nanosecondsASpawn},
      {"spawning.embree", "the same through Embree, and nearest hits and shadows by the triangle that the ray leaves", "ulp of the largest coordinate, the widest gap",
       200'000, runEmbree, nanosecondsASpawn},
      {"spawning.needs", "how far off a triangle a ray that leaves it would meet it again without an epsilon", "rounding units of the largest coordinate", 10'000'000, runNeeds,
       nanosecondsASpawn},
      {"spawning.hitPoints", "the distance of the hit point from its triangle's plane", "rounding units of the largest coordinate", 10'000'000, runHitPoints, nanosecondsASpawn},
  };
}

} // namespace rtsl::numerics
