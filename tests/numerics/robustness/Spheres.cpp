//===- Spheres.cpp - the example's sphere, small, large and far -----------===//
#include "RayTarget.h"
#include "Row.h"
#include "Timing.h"
#include "Worst.h"

#include "runtime/device/Spawn.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace rtsl::numerics {

namespace {

using device::Vec3;

/// examples/glass/Sphere.rtsl, with any centre and radius.
class Sphere : public RayTarget {
public:
  explicit Sphere(Path path) : RayTarget("examples/glass/Sphere.rtsl", "Sphere", {{"center", {0, 0, 0}}, {"radius", targetRoom}}, path) {}

  void place(Vec3 at, float size) {
    center = at;
    radius = size;
    set("center", {at.x, at.y, at.z});
    set("radius", {size});
  }
  std::string show(const Ray &ray) const {
    return fmt::format("center {}, radius {:a}, {}", numerics::show(center), radius, ray.text());
  }

  Vec3 center{};
  float radius = 1;
};

Sphere &sphere(Path path) {
  static Sphere only(path); // a program has one
  return only;
}

/// The exact line: how far it passes from the centre.
Precise passing(const Sphere &sphere, const Ray &ray) {
  const PreciseVec3 f = precise(ray.origin) - precise(sphere.center), d = precise(ray.direction);
  const Precise t = -dot(f, d) / dot(d, d);
  return length(along(f, t, d));
}

/// How far the point at the answer's t is from the sphere, in rounding units of the origin's and the ray's largest coordinate:
/// what device::primitivePointError bounds.
double offTheSphere(const Sphere &sphere, const Ray &ray, float t) {
  const PreciseVec3 point = along(precise(ray.origin), Precise(t), precise(ray.direction)) - precise(sphere.center);
  return static_cast<double>(abs(length(point) - Precise(sphere.radius)) / pointUnit(ray, t));
}

/// A ray that passes the centre at about `impact`, from `distance` away.
Ray aimedAt(Random &random, const Sphere &sphere, float distance, float impact) { return aimedFrom(random, sphere.center, sphere.radius, distance, impact); }

/// The error of an answer that should be a hit or a miss: how near the line passes to where that changes, in rounding units of the
/// distance. Nothing is wrong with an answer that is right.
void judgeHit(const Sphere &sphere, const Ray &ray, bool isHit, Worst &worst) {
  const Precise passes = passing(sphere, ray), radius(sphere.radius);
  const bool isWrong = isHit != (passes < radius);
  const Precise distance = length(precise(ray.origin) - precise(sphere.center));
  worst.add(isWrong ? static_cast<double>(abs(passes - radius) / (distance * Precise(0x1p-24))) : 0, [&] { return sphere.show(ray); });
}

Outcome runFar(Path path, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  Sphere &target = sphere(path);
  for (std::uint64_t i = 0; i < cases; ++i) {
    const float radius = powerOfTen(random, -6, 6), distance = std::min(1e7f, radius * powerOfTen(random, 0.2f, 13));
    target.place(random.integer(0, 1) ? Vec3{0, 0, 0} : random.inBox(radius), radius);
    const Ray ray = aimedAt(random, target, distance, radius * random.between(0, 2));
    judgeHit(target, ray, target.meet(ray.origin, ray.direction).has_value(), worst);
  }
  return worst.outcome();
}

Outcome runGrazing(Path path, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  Sphere &target = sphere(path);
  for (std::uint64_t i = 0; i < cases; ++i) {
    const float radius = powerOfTen(random, -6, 6), distance = std::min(1e7f, radius * powerOfTen(random, 0.2f, 3));
    target.place(random.integer(0, 1) ? Vec3{0, 0, 0} : random.inBox(radius), radius);
    const float beside = random.integer(0, 1) ? 1e-7f : -1e-7f;
    const Ray ray = aimedAt(random, target, distance, radius + radius * beside);
    judgeHit(target, ray, target.meet(ray.origin, ray.direction).has_value(), worst);
  }
  return worst.outcome();
}

/// Hit points, of rays from outside.
Outcome runPoints(Path path, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  Sphere &target = sphere(path);
  for (std::uint64_t i = 0; i < cases; ++i) {
    const float radius = powerOfTen(random, -6, 6), distance = std::min(1e7f, radius * powerOfTen(random, 0.2f, 13));
    target.place(random.integer(0, 1) ? Vec3{0, 0, 0} : random.inBox(10 * radius), radius);
    const Ray ray = aimedAt(random, target, distance, radius * (random.integer(0, 3) ? random.between(0, 1) : 1 - 1e-7f));
    if (const auto t = target.meet(ray.origin, ray.direction))
      worst.add(offTheSphere(target, ray, *t), [&] { return target.show(ray); });
  }
  return worst.outcome();
}

/// From inside every ray meets the sphere, at one point.
Outcome runInside(Path path, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  Sphere &target = sphere(path);
  for (std::uint64_t i = 0; i < cases; ++i) {
    const float radius = powerOfTen(random, -6, 6);
    target.place(random.inBox(10 * radius), radius);
    const float depth = i % 3 == 0 ? random.between(0, 0.999f) : i % 3 == 1 ? 0.0f : 0.99999f;
    const Vec3 origin = target.center + random.direction() * (radius * depth), direction = random.direction() * std::ldexp(1.0f, random.integer(-20, 20));
    if (length(precise(origin) - precise(target.center)) >= Precise(radius) * Precise(1 - 1e-6))
      continue; // rounding took it to the surface
    const Ray ray = {origin, direction};
    if (const auto t = target.meet(origin, direction))
      worst.add(offTheSphere(target, ray, *t), [&] { return target.show(ray); });
    else
      worst.wrong("missed: " + target.show(ray));
  }
  return worst.outcome();
}

/// Rays that leave a point of the surface: outwards they meet nothing, inwards the other side.
Outcome runSurface(Path path, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  Sphere &target = sphere(path);
  for (std::uint64_t i = 0; i < cases; ++i) {
    const float radius = powerOfTen(random, -6, 6), distance = std::min(1e7f, radius * powerOfTen(random, 0.2f, 3));
    target.place(random.inBox(10 * radius), radius);
    const Ray ray = aimedAt(random, target, distance, radius * random.between(0, 0.99f));
    const auto t = target.meet(ray.origin, ray.direction);
    if (!t)
      continue;
    const Vec3 point = pointAt(ray, *t), direction = random.direction() * std::ldexp(1.0f, random.integer(-20, 20));
    const float cosine = device::dot(device::normalized(direction), device::normalized(point - target.center));
    // Inwards the chord, 2 r |cosine|, must be longer than what epsilon skips, 1.74 error / |cosine|.
    const float error = device::primitivePointError(ray.origin, ray.direction, *t);
    if (cosine * cosine < 2 * error / radius || std::fabs(cosine) < 2 * device::smallestCosine)
      continue;
    worst.count(target.meetsAgain(ray.origin, ray.direction, direction) != (cosine < 0), [&] { return target.show({point, direction}); });
  }
  return worst.outcome();
}

double nanosecondsAMeeting(Path path) {
  Sphere &target = sphere(path);
  target.place({0, 0, 0}, 1);
  constexpr int count = 100'000;
  return timeOf(count, [&] {
    float sum = 0;
    for (int i = 0; i < count; ++i)
      sum += *target.meet({0.001f * float(i & 255), 0.25f, 5}, {0, 0, -1});
    return sum;
  });
}

} // namespace

std::vector<Row> sphereRows(Path path) {
  const auto row = [&](const char *name, const char *description, const char *unit, std::uint64_t cases, auto run) {
    return Row{name, description, unit, cases, [=](std::uint64_t n, std::uint32_t seed) { return run(path, n, seed); },
               [=] { return nanosecondsAMeeting(path); }};
  };
  const char *near = "between hit and miss, rounding units of the distance";
  const char *off = "off the sphere, rounding units of the largest coordinate";
  return {
      row("spheres.far", "radius 1e-6 to 1e6 at distances up to 1e7: how near to the silhouette a ray passes that is told the wrong answer", near, 200'000, runFar),
      row("spheres.grazing", "the same for rays that pass at r (1 + 1e-7) and r (1 - 1e-7)", near, 200'000, runGrazing),
      row("spheres.points", "hit points of rays from outside", off, 200'000, runPoints),
      row("spheres.inside", "rays from inside, from the centre and from just below the surface: all of them meet it", off, 200'000, runInside),
      row("spheres.surface", "rays that leave a hit point of the surface: those that meet it outwards, or miss it inwards", "rays", 1'000'000, runSurface),
  };
}

} // namespace rtsl::numerics
