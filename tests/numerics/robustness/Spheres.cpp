//===- Spheres.cpp - the example's sphere, small, large and far -----------===//
#include "QuadricTarget.h"
#include "Row.h"
#include "Timing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace rtsl::numerics {

namespace {

using device::Vec3;

/// examples/glass/Sphere.rtsl, with any centre and radius.
class Sphere : public QuadricTarget {
public:
  explicit Sphere(Path path)
      : QuadricTarget("examples/glass/Sphere.rtsl", "Sphere",
                      {{"center", {0, 0, 0}}, {"radius", targetRoom}}, path) {}

  void place(Vec3 at, float size) {
    center = at;
    radius = size;
    level = Precise(size) * Precise(size);
    set("center", {at.x, at.y, at.z});
    set("radius", {size});
  }
  /// A ray that passes the centre at about `impact`, from `distance` away.
  Ray aimedAt(Random &random, float distance, float impact) const {
    return aimedFrom(random, center, radius, distance, impact);
  }

private:
  std::string show(const Ray &ray) const override {
    return fmt::format("center {}, radius {:a}, {}", numerics::show(center), radius, ray.text());
  }

  float radius = 1;
};

Sphere &sphere(Path path) {
  static Sphere only(path); // a program has one
  return only;
}

Outcome runFar(Path path, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  Sphere &target = sphere(path);
  for (std::uint64_t i = 0; i < cases; ++i) {
    const float radius = powerOfTen(random, -6, 6),
                distance = std::min(1e7f, radius * powerOfTen(random, 0.2f, 13));
    target.place(random.integer(0, 1) ? Vec3{0, 0, 0} : random.inBox(radius), radius);
    target.judgeSilhouette(target.aimedAt(random, distance, radius * random.between(0, 2)), radius,
                           worst);
  }
  return worst.outcome();
}

Outcome runGrazing(Path path, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  Sphere &target = sphere(path);
  for (std::uint64_t i = 0; i < cases; ++i) {
    const float radius = powerOfTen(random, -6, 6),
                distance = std::min(1e7f, radius * powerOfTen(random, 0.2f, 3));
    target.place(random.integer(0, 1) ? Vec3{0, 0, 0} : random.inBox(radius), radius);
    const float beside = random.integer(0, 1) ? 1e-7f : -1e-7f;
    target.judgeSilhouette(target.aimedAt(random, distance, radius + radius * beside), radius,
                           worst);
  }
  return worst.outcome();
}

/// Hit points, of rays from outside.
Outcome runPoints(Path path, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  Sphere &target = sphere(path);
  for (std::uint64_t i = 0; i < cases; ++i) {
    const float radius = powerOfTen(random, -6, 6),
                distance = std::min(1e7f, radius * powerOfTen(random, 0.2f, 13));
    target.place(random.integer(0, 1) ? Vec3{0, 0, 0} : random.inBox(10 * radius), radius);
    target.judgePoint(
        target.aimedAt(random, distance,
                       radius * (random.integer(0, 3) ? random.between(0, 1) : 1 - 1e-7f)),
        worst);
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
    const Ray ray = {target.center + random.direction() * (radius * depth),
                     random.direction() * std::ldexp(1.0f, random.integer(-20, 20))};
    if (target.isInside(ray.origin, 2e-6)) // rounding may have taken it to the surface
      target.judgeInside(ray, worst);
  }
  return worst.outcome();
}

/// Rays that leave a point of the surface: outwards they meet nothing, inwards the other side.
Outcome runSurface(Path path, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  Sphere &target = sphere(path);
  for (std::uint64_t i = 0; i < cases; ++i) {
    const float radius = powerOfTen(random, -6, 6),
                distance = std::min(1e7f, radius * powerOfTen(random, 0.2f, 3));
    target.place(random.inBox(10 * radius), radius);
    const Ray ray = target.aimedAt(random, distance, radius * random.between(0, 0.99f));
    target.judgeLeaving(ray, random.direction() * std::ldexp(1.0f, random.integer(-20, 20)), worst);
  }
  return worst.outcome();
}

double nanosecondsAMeeting(Path path) {
  Sphere &target = sphere(path);
  target.place({0, 0, 0}, 1);
  return nanosecondsToMeet(target);
}

} // namespace

std::vector<Row> sphereRows(Path path) {
  const auto row = rowsOf(path, nanosecondsAMeeting);
  const char *near = "between hit and miss, rounding units of the distance";
  const char *off = "off the sphere, rounding units of the largest coordinates of ray and centre";
  return {
      row("spheres.far",
          "radius 1e-6 to 1e6 at distances up to 1e7: how near to the silhouette a ray passes that "
          "is classified wrongly",
          near, 200'000, runFar),
      row("spheres.grazing", "the same for rays that pass at r (1 + 1e-7) and r (1 - 1e-7)", near,
          200'000, runGrazing),
      row("spheres.points", "hit points of rays from outside", off, 200'000, runPoints),
      row("spheres.inside",
          "rays from inside, from the centre and from just below the surface: all of them meet it",
          off, 200'000, runInside),
      row("spheres.surface",
          "rays that leave a hit point of the surface: those that meet it outwards, or miss it "
          "inwards",
          "rays", 1'000'000, runSurface),
  };
}

} // namespace rtsl::numerics
