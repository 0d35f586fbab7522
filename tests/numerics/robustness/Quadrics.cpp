//===- Quadrics.cpp - ellipsoids, cylinders, cones and hyperboloids -------===//
#include "RayTarget.h"
#include "Row.h"
#include "Timing.h"
#include "Worst.h"

#include "runtime/device/Spawn.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace rtsl::numerics {

namespace {

using device::Vec3;

/// shaders/Quadric.rtsl: a x^2 + b y^2 + c z^2 = level, in a box.
class Quadric : public RayTarget {
public:
  explicit Quadric(Path path)
      : RayTarget("tests/numerics/robustness/shaders/Quadric.rtsl", "Quadric", {{"extent", {targetRoom, targetRoom, targetRoom}}}, path) {}

  /// The box is a cube with sides of 2 `reach`.
  void place(Vec3 at, Vec3 theCoefficients, float theLevel, float theReach) {
    center = at;
    coefficients = theCoefficients;
    level = theLevel;
    reach = theReach;
    set("center", {at.x, at.y, at.z});
    set("coefficients", {coefficients.x, coefficients.y, coefficients.z});
    set("level", {level});
    set("extent", {reach, reach, reach});
  }
  std::string show(const Ray &ray) const {
    return fmt::format("center {}, coefficients {}, level {:a}, reach {:a}, {}", numerics::show(center), numerics::show(coefficients), level, reach,
                       ray.text());
  }

  PreciseVec3 gradient(const PreciseVec3 &p) const {
    return {Precise(coefficients.x) * p[0], Precise(coefficients.y) * p[1], Precise(coefficients.z) * p[2]};
  }
  /// a p.x q.x + b p.y q.y + c p.z q.z.
  Precise form(const PreciseVec3 &p, const PreciseVec3 &q) const { return dot(gradient(p), q); }

  Vec3 center{}, coefficients{};
  float level = 1, reach = 1;
};

Quadric &quadric(Path path) {
  static Quadric only(path); // a program has one
  return only;
}

/// How far a ray's point is from the surface, in rounding units of the largest coordinate: the step to where a form with this
/// value, slope and largest curvature is 0. But for a cone's apex, where the slope ends, that is value / slope.
double offTheSurface(const Quadric &quadric, const Ray &ray, float t) {
  const PreciseVec3 point = along(precise(ray.origin), Precise(t), precise(ray.direction)) - precise(quadric.center);
  const Precise value = abs(quadric.form(point, point) - Precise(quadric.level)), slope = 2 * length(quadric.gradient(point));
  const Precise curvature = device::largest(quadric.coefficients);
  const Precise distance = value == 0 ? Precise(0) : Precise(2 * value / (slope + sqrt(slope * slope + 4 * curvature * value)));
  return static_cast<double>(distance / pointUnit(ray, t));
}

/// An ellipsoid whose half axes are `size` times at most `ratio` and one over that; gives the shortest.
float placeEllipsoid(Random &random, Quadric &target, Vec3 at, float size, float ratio) {
  std::array<float, 3> axes;
  for (float &axis : axes)
    axis = size * std::pow(ratio, random.between(-1, 1));
  const auto inverseSquare = [&](float axis) { return (size / axis) * (size / axis); };
  target.place(at, {inverseSquare(axes[0]), inverseSquare(axes[1]), inverseSquare(axes[2])}, size * size, 2 * size * ratio);
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
    const float size = powerOfTen(random, -6, 6), distance = std::min(1e7f, size * powerOfTen(random, 0.2f, 13));
    placeAny(random, target, random.integer(0, 1) ? Vec3{0, 0, 0} : random.inBox(10 * std::min(size, 1e6f)), size);
    const Ray ray = aimedFrom(random, target.center, size, distance, size * random.between(0, 2));
    if (const auto t = target.meet(ray.origin, ray.direction))
      worst.add(offTheSurface(target, ray, *t), [&] { return target.show(ray); });
  }
  return worst.outcome();
}

/// Ellipsoids: is a ray told rightly whether it meets one? Scaled to a sphere of radius 1, the line passes the centre at some
/// distance; that one moves by at most a shortest half axis' inverse when the ray moves by 1.
Outcome runSilhouettes(Path path, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  Quadric &target = quadric(path);
  for (std::uint64_t i = 0; i < cases; ++i) {
    const float size = powerOfTen(random, -6, 6), distance = std::min(1e7f, size * powerOfTen(random, 1.5f, 13));
    const float shortest = placeEllipsoid(random, target, random.integer(0, 1) ? Vec3{0, 0, 0} : random.inBox(size), size, 3);
    const Ray ray = aimedFrom(random, target.center, size, distance, size * random.between(0, 2));
    const bool isHit = target.meet(ray.origin, ray.direction).has_value();
    const PreciseVec3 f = precise(ray.origin) - precise(target.center), d = precise(ray.direction);
    const PreciseVec3 nearest = along(f, -target.form(f, d) / target.form(d, d), d);
    const Precise passes = sqrt(target.form(nearest, nearest) / Precise(target.level));
    const bool isWrong = isHit != (passes < 1);
    worst.add(isWrong ? static_cast<double>(abs(passes - 1) * Precise(shortest) / (length(f) * Precise(0x1p-24))) : 0, [&] { return target.show(ray); });
  }
  return worst.outcome();
}

/// From inside an ellipsoid every ray meets it.
Outcome runInside(Path path, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  Quadric &target = quadric(path);
  for (std::uint64_t i = 0; i < cases; ++i) {
    const float size = powerOfTen(random, -6, 6);
    const float shortest = placeEllipsoid(random, target, random.inBox(10 * size), size, mostRatio);
    const float depth = i % 3 == 0 ? random.between(0, 0.999f) : i % 3 == 1 ? 0.0f : 0.999f;
    const Ray ray = {target.center + random.direction() * (shortest * depth), random.direction() * std::ldexp(1.0f, random.integer(-20, 20))};
    const PreciseVec3 f = precise(ray.origin) - precise(target.center);
    if (target.form(f, f) >= Precise(target.level) * Precise(1 - 1e-4))
      continue; // rounding took it to the surface
    if (const auto t = target.meet(ray.origin, ray.direction))
      worst.add(offTheSurface(target, ray, *t), [&] { return target.show(ray); });
    else
      worst.wrong("missed: " + target.show(ray));
  }
  return worst.outcome();
}

/// Rays that leave a point of an ellipsoid: outwards they meet nothing, inwards the other side.
Outcome runSurface(Path path, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  Quadric &target = quadric(path);
  for (std::uint64_t i = 0; i < cases; ++i) {
    const float size = powerOfTen(random, -6, 6), distance = std::min(1e7f, size * powerOfTen(random, 1, 3));
    placeEllipsoid(random, target, random.inBox(10 * size), size, 3);
    const Ray ray = aimedFrom(random, target.center, size, distance, size * random.between(0, 0.3f));
    const auto t = target.meet(ray.origin, ray.direction);
    if (!t)
      continue;
    const Vec3 point = pointAt(ray, *t), direction = random.direction() * std::ldexp(1.0f, random.integer(-20, 20));
    const PreciseVec3 f = precise(point) - precise(target.center), d = precise(direction), normal = target.gradient(f);
    const double cosine = static_cast<double>(dot(normal, d) / (length(normal) * length(d)));
    // Inwards the chord must be longer than what epsilon skips, 1.74 error / |cosine|.
    const Precise chord = 2 * abs(target.form(f, d)) / target.form(d, d) * length(d);
    const double error = device::primitivePointError(ray.origin, ray.direction, *t);
    if (static_cast<double>(chord) < 4 * error / std::fabs(cosine) || std::fabs(cosine) < 2 * device::smallestCosine)
      continue;
    worst.count(target.meetsAgain(ray.origin, ray.direction, direction) != (cosine < 0), [&] { return target.show({point, direction}); });
  }
  return worst.outcome();
}

double nanosecondsAMeeting(Path path) {
  Quadric &target = quadric(path);
  target.place({0, 0, 0}, {1, 1, 1}, 1, 2);
  constexpr int count = 100'000;
  return timeOf(count, [&] {
    float sum = 0;
    for (int i = 0; i < count; ++i)
      sum += *target.meet({0.001f * float(i & 255), 0.25f, 5}, {0, 0, -1});
    return sum;
  });
}

} // namespace

std::vector<Row> quadricRows(Path path) {
  const auto row = [&](const char *name, const char *description, const char *unit, std::uint64_t cases, auto run) {
    return Row{name, description, unit, cases, [=](std::uint64_t n, std::uint32_t seed) { return run(path, n, seed); }, [=] { return nanosecondsAMeeting(path); }};
  };
  const char *off = "off the surface, rounding units of the largest coordinate";
  return {
      row("quadrics.points", "ellipsoids, cylinders, cones and hyperboloids of size 1e-6 to 1e6 at distances up to 1e7: hit points", off, 200'000, runPoints),
      row("quadrics.silhouettes", "the same for ellipsoids with axes of 1/3 to 3: how near to the silhouette a ray passes that is told the wrong answer",
          "between hit and miss, rounding units of the distance", 200'000, runSilhouettes),
      row("quadrics.inside", "rays from inside of ellipsoids with axes of 1/30 to 30: all of them meet it", off, 200'000, runInside),
      row("quadrics.surface", "rays that leave a hit point of an ellipsoid: those that meet it outwards, or miss it inwards", "rays", 1'000'000, runSurface),
  };
}

} // namespace rtsl::numerics
