//===- Quadrics.cpp - ellipsoids, cylinders, cones and hyperboloids -------===//
#include "QuadricTarget.h"
#include "Row.h"
#include "Timing.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace rtsl::numerics {

namespace {

using device::Vec3;

/// examples/quadrics/Quadric.rtsl, in a box.
class Quadric : public QuadricTarget {
public:
  explicit Quadric(Path path)
      : QuadricTarget("examples/quadrics/Quadric.rtsl", "Quadric",
                      {{"extent", {targetRoom, targetRoom, targetRoom}}}, path) {}

  /// The box is a cube with sides of 2 `theReach`.
  void place(Vec3 at, Vec3 theCoefficients, float theLevel, float theReach) {
    center = at;
    coefficients = theCoefficients;
    level = theLevel;
    reach = theReach;
    set("center", {at.x, at.y, at.z});
    set("coefficients", {coefficients.x, coefficients.y, coefficients.z});
    set("level", {theLevel});
    set("extent", {reach, reach, reach});
  }

private:
  std::string show(const Ray &ray) const override {
    return fmt::format("center {}, coefficients {}, level {:a}, reach {:a}, {}",
                       numerics::show(center), numerics::show(coefficients),
                       static_cast<float>(level), reach, ray.text());
  }

  float reach = 1;
};

Quadric &quadric(Path path) {
  static Quadric only(path); // a program has one
  return only;
}

/// An ellipsoid whose half axes are `size` times at most `ratio` and one over that; gives the
/// shortest.
float placeEllipsoid(Random &random, Quadric &target, Vec3 at, float size, float ratio) {
  std::array<float, 3> axes;
  for (float &axis : axes)
    axis = size * std::pow(ratio, random.between(-1, 1));
  const auto inverseSquare = [&](float axis) { return (size / axis) * (size / axis); };
  target.place(at, {inverseSquare(axes[0]), inverseSquare(axes[1]), inverseSquare(axes[2])},
               size * size, 2 * size * ratio);
  return *std::min_element(axes.begin(), axes.end());
}

constexpr float mostRatio = 30;

/// A sphere, an ellipsoid, a cylinder, a cone or a hyperboloid of one or two sheets.
void placeAny(Random &random, Quadric &target, Vec3 at, float size) {
  Vec3 coefficients = {random.between(0.1f, 4), random.between(0.1f, 4), random.between(0.1f, 4)};
  float level = size * size;
  switch (random.integer(0, 5)) {
  case 0:
    coefficients = {1, 1, 1};
    break;
  case 1:
    placeEllipsoid(random, target, at, size, mostRatio);
    return;
  case 2:
    coefficients.y = 0;
    break;
  case 3:
    coefficients.y = -coefficients.y;
    level = 0;
    break;
  case 4:
    coefficients.y = -coefficients.y;
    break;
  default:
    coefficients.x = -coefficients.x;
    coefficients.z = -coefficients.z;
  }
  target.place(at, coefficients, level, 4 * size);
}

Outcome runPoints(Path path, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  Quadric &target = quadric(path);
  for (std::uint64_t i = 0; i < cases; ++i) {
    const float size = powerOfTen(random, -6, 6),
                distance = std::min(1e7f, size * powerOfTen(random, 0.2f, 13));
    placeAny(random, target,
             random.integer(0, 1) ? Vec3{0, 0, 0} : random.inBox(10 * std::min(size, 1e6f)), size);
    target.judgePoint(aimedFrom(random, target.center, size, distance, size * random.between(0, 2)),
                      worst);
  }
  return worst.outcome();
}

Outcome runSilhouettes(Path path, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  Quadric &target = quadric(path);
  for (std::uint64_t i = 0; i < cases; ++i) {
    const float size = powerOfTen(random, -6, 6),
                distance = std::min(1e7f, size * powerOfTen(random, 1.5f, 13));
    const float shortest = placeEllipsoid(
        random, target, random.integer(0, 1) ? Vec3{0, 0, 0} : random.inBox(size), size, 3);
    target.judgeSilhouette(
        aimedFrom(random, target.center, size, distance, size * random.between(0, 2)), shortest,
        worst);
  }
  return worst.outcome();
}

/// Rays that touch an ellipsoid but for rounding.
Outcome runTangents(Path path, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  Quadric &target = quadric(path);
  for (std::uint64_t i = 0; i < cases; ++i) {
    const float size = powerOfTen(random, -6, 6),
                distance = std::min(1e7f, size * powerOfTen(random, 2, 13));
    const float shortest = placeEllipsoid(
        random, target, random.integer(0, 1) ? Vec3{0, 0, 0} : random.inBox(size), size, 10);
    // How near a ray passes is in proportion to where it is aimed, nearly.
    float impact = size;
    const Random before = random;
    for (int step = 0; step < 3; ++step) {
      random = before;
      impact /= static_cast<float>(
          target.passing(aimedFrom(random, target.center, size, distance, impact)));
    }
    impact += impact * random.between(-1, 1) * 1e-6f;
    Random again = before;
    target.judgeSilhouette(aimedFrom(again, target.center, size, distance, impact), shortest,
                           worst);
  }
  return worst.outcome();
}

Outcome runInside(Path path, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  Quadric &target = quadric(path);
  for (std::uint64_t i = 0; i < cases; ++i) {
    const float size = powerOfTen(random, -6, 6);
    const float shortest = placeEllipsoid(random, target, random.inBox(10 * size), size, mostRatio);
    const float depth = i % 3 == 0 ? random.between(0, 0.999f) : i % 3 == 1 ? 0.0f : 0.999f;
    const Ray ray = {target.center + random.direction() * (shortest * depth),
                     random.direction() * std::ldexp(1.0f, random.integer(-20, 20))};
    if (target.isInside(ray.origin, 1e-4)) // rounding may have taken it to the surface
      target.judgeInside(ray, worst);
  }
  return worst.outcome();
}

Outcome runSurface(Path path, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  Quadric &target = quadric(path);
  for (std::uint64_t i = 0; i < cases; ++i) {
    const float size = powerOfTen(random, -6, 6),
                distance = std::min(1e7f, size * powerOfTen(random, 1, 3));
    placeEllipsoid(random, target, random.inBox(10 * size), size, 3);
    const Ray ray =
        aimedFrom(random, target.center, size, distance, size * random.between(0, 0.3f));
    target.judgeLeaving(ray, random.direction() * std::ldexp(1.0f, random.integer(-20, 20)), worst);
  }
  return worst.outcome();
}

double nanosecondsAMeeting(Path path) {
  Quadric &target = quadric(path);
  target.place({0, 0, 0}, {1, 1, 1}, 1, 2);
  return nanosecondsToMeet(target);
}

} // namespace

std::vector<Row> quadricRows(Path path) {
  const auto row = rowsOf(path, nanosecondsAMeeting);
  const char *off = "off the surface, rounding units of the largest coordinates of ray and centre";
  return {
      row("quadrics.points",
          "ellipsoids, cylinders, cones and hyperboloids of size 1e-6 to 1e6 at distances up to "
          "1e7: hit points",
          off, 200'000, runPoints),
      row("quadrics.silhouettes",
          "the same for ellipsoids with axes of 1/3 to 3: how near to the silhouette a ray passes "
          "that is classified wrongly",
          "between hit and miss, rounding units of the distance", 200'000, runSilhouettes),
      row("quadrics.tangents",
          "the same for axes of 1/10 to 10 and rays that pass within about 1e-6 of the silhouette",
          "between hit and miss, rounding units of the distance", 200'000, runTangents),
      row("quadrics.inside",
          "rays from inside of ellipsoids with axes of 1/30 to 30: all of them meet it", off,
          200'000, runInside),
      row("quadrics.surface",
          "rays that leave a hit point of an ellipsoid: those that meet it outwards, or miss it "
          "inwards",
          "rays", 1'000'000, runSurface),
  };
}

} // namespace rtsl::numerics
