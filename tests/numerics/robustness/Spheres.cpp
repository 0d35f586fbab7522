//===- Spheres.cpp - the example's sphere, small, large and far -----------===//
#include "CompiledShaders.h"
#include "Generators.h"
#include "HighPrecision.h"
#include "Row.h"
#include "Timing.h"
#include "Worst.h"

#include "runtime/device/Spawn.h"
#include "runtime/device/Surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace rtsl::numerics {

namespace {

using device::Vec3;

/// examples/glass/Sphere.rtsl, with any centre and radius.
class Sphere {
public:
  explicit Sphere(FloatingPoint floatingPoint)
      : shaders({"examples/glass/Sphere.rtsl", "tests/numerics/robustness/shaders/Reader.rtsl", "tests/numerics/robustness/shaders/Probe.rtsl"},
                {"Sphere", "Reader", "Probe"}, {{"Sphere", "Reader"}}, floatingPoint) {
    runtime::Scene &scene = shaders.scene();
    object = scene.addObject("Sphere", runtime::ObjectValues{{}, {{"center", {0, 0, 0}}}, {}});
    scene.addPrimitive(object, scene.addObject("Reader"));
    scene.setCamera(scene.addObject("Probe"));
    shaders.finish();
    centerMember = shaders.member(object, "center");
    radiusMember = shaders.member(object, "radius");
  }

  void place(Vec3 at, float size) {
    center = at;
    radius = size;
    device::store(centerMember, at);
    *radiusMember = size;
  }

  /// Whether the ray meets the sphere beyond epsilon; then state's HitDistance says where.
  bool meet(Vec3 origin, Vec3 direction, RtslState &state, float epsilon = 0) const {
    state = shaders.ray();
    device::store(state.RayOrigin, origin);
    device::store(state.RayDirection, direction);
    state.Epsilon = epsilon;
    state.candidateInstance = state.candidatePrimitive = 0;
    shaders.slots().rt_Primitive_intersect(&state, object);
    return state.instance != RTSL_NO_HIT;
  }
  void describe(RtslState &state) const { device::describePrimitive(state, object, RTSL_NEEDS_NORMALS, shaders.slots()); }

  std::string show(Vec3 origin, Vec3 direction) const {
    return fmt::format("center {}, radius {:a}, origin {}, direction {}", numerics::show(center), radius, numerics::show(origin), numerics::show(direction));
  }

  Vec3 center{};
  float radius = 1;

private:
  CompiledShaders shaders;
  RtslRef object;
  float *centerMember, *radiusMember;
};

Sphere &sphere(FloatingPoint floatingPoint) {
  static Sphere only(floatingPoint); // a program has one mode
  return only;
}

float powerOfTen(Random &random, float low, float high) { return std::pow(10.0f, random.between(low, high)); }

/// The exact line: how far it passes from the centre.
Precise passing(const Sphere &sphere, Vec3 origin, Vec3 direction) {
  const PreciseVec3 f = precise(origin) - precise(sphere.center), d = precise(direction);
  const Precise t = -dot(f, d) / dot(d, d);
  return length(along(f, t, d));
}

/// How far the point at the answer's t is from the sphere, in rounding units of the origin's and the ray's largest coordinate:
/// what device::primitivePointError bounds.
double offTheSphere(const Sphere &sphere, Vec3 origin, Vec3 direction, float t) {
  const PreciseVec3 point = along(precise(origin), Precise(t), precise(direction)) - precise(sphere.center);
  const Precise unit = Precise(0x1p-24) * (Precise(device::largest(origin)) + abs(Precise(t)) * Precise(device::largest(direction)));
  return static_cast<double>(abs(length(point) - Precise(sphere.radius)) / unit);
}

struct Ray {
  Vec3 origin, direction;
};

/// The same along an axis. Coordinates across are small in their own right, so that even a sphere of 1e-6 can be aimed at from 1e7.
Ray aimedAlongAnAxis(Random &random, const Sphere &sphere, float distance, float impact) {
  const float angle = random.between(0, 6.2831853f), tilt = random.between(-4, 4) * sphere.radius, slant = random.between(-4, 4) * sphere.radius;
  const float across = impact * std::cos(angle), up = impact * std::sin(angle);
  const float towards[3] = {-1, (across - tilt) / distance, (up - slant) / distance}, from[3] = {distance, tilt, slant};
  const int axis = random.integer(0, 2);
  const float sign = random.integer(0, 1) ? 1.0f : -1.0f, scale = random.between(1, 2) * std::ldexp(1.0f, random.integer(-10, 10));
  float origin[3], direction[3];
  for (int i = 0; i < 3; ++i) {
    origin[(axis + i) % 3] = from[i] * (i == 0 ? sign : 1);
    direction[(axis + i) % 3] = towards[i] * (i == 0 ? sign : 1) * scale;
  }
  return {sphere.center + device::load(origin), device::load(direction)};
}

/// A ray that passes the centre at about `impact`, from `distance` away.
Ray aimedFrom(Random &random, const Sphere &sphere, float distance, float impact) {
  if (distance > 1e5f * sphere.radius || random.integer(0, 1))
    return aimedAlongAnAxis(random, sphere, distance, impact);
  const Vec3 towards = random.direction(), beside = device::normalized(device::cross(towards, random.direction()));
  const Vec3 origin = sphere.center - towards * distance, aim = sphere.center + beside * impact;
  return {origin, (aim - origin) * (random.between(1, 2) * std::ldexp(1.0f, random.integer(-10, 10)))};
}

/// The error of an answer that should be a hit or a miss: how near the line passes to where that changes, in rounding units of the
/// distance. Nothing is wrong with an answer that is right.
void judgeHit(const Sphere &sphere, const Ray &ray, bool isHit, Worst &worst) {
  const Precise passes = passing(sphere, ray.origin, ray.direction), radius(sphere.radius);
  const bool isWrong = isHit != (passes < radius);
  const Precise distance = length(precise(ray.origin) - precise(sphere.center));
  worst.add(isWrong ? static_cast<double>(abs(passes - radius) / (distance * Precise(0x1p-24))) : 0, [&] { return sphere.show(ray.origin, ray.direction); });
}

Outcome runFar(FloatingPoint floatingPoint, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  Sphere &target = sphere(floatingPoint);
  for (std::uint64_t i = 0; i < cases; ++i) {
    const float radius = powerOfTen(random, -6, 6), distance = std::min(1e7f, radius * powerOfTen(random, 0.2f, 13));
    target.place(random.integer(0, 1) ? Vec3{0, 0, 0} : random.inBox(radius), radius);
    const Ray ray = aimedFrom(random, target, distance, radius * random.between(0, 2));
    RtslState state;
    judgeHit(target, ray, target.meet(ray.origin, ray.direction, state), worst);
  }
  return worst.outcome();
}

Outcome runGrazing(FloatingPoint floatingPoint, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  Sphere &target = sphere(floatingPoint);
  for (std::uint64_t i = 0; i < cases; ++i) {
    const float radius = powerOfTen(random, -6, 6), distance = std::min(1e7f, radius * powerOfTen(random, 0.2f, 3));
    target.place(random.integer(0, 1) ? Vec3{0, 0, 0} : random.inBox(radius), radius);
    const float beside = random.integer(0, 1) ? 1e-7f : -1e-7f;
    const Ray ray = aimedFrom(random, target, distance, radius + radius * beside);
    RtslState state;
    judgeHit(target, ray, target.meet(ray.origin, ray.direction, state), worst);
  }
  return worst.outcome();
}

/// Hit points, of rays from outside.
Outcome runPoints(FloatingPoint floatingPoint, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  Sphere &target = sphere(floatingPoint);
  for (std::uint64_t i = 0; i < cases; ++i) {
    const float radius = powerOfTen(random, -6, 6), distance = std::min(1e7f, radius * powerOfTen(random, 0.2f, 13));
    target.place(random.integer(0, 1) ? Vec3{0, 0, 0} : random.inBox(10 * radius), radius);
    const Ray ray = aimedFrom(random, target, distance, radius * (random.integer(0, 3) ? random.between(0, 1) : 1 - 1e-7f));
    RtslState state;
    if (target.meet(ray.origin, ray.direction, state))
      worst.add(offTheSphere(target, ray.origin, ray.direction, state.HitDistance), [&] { return target.show(ray.origin, ray.direction); });
  }
  return worst.outcome();
}

/// From inside every ray meets the sphere, at one point.
Outcome runInside(FloatingPoint floatingPoint, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  Sphere &target = sphere(floatingPoint);
  for (std::uint64_t i = 0; i < cases; ++i) {
    const float radius = powerOfTen(random, -6, 6);
    target.place(random.inBox(10 * radius), radius);
    const float depth = i % 3 == 0 ? random.between(0, 0.999f) : i % 3 == 1 ? 0.0f : 0.99999f;
    const Vec3 origin = target.center + random.direction() * (radius * depth), direction = random.direction() * std::ldexp(1.0f, random.integer(-20, 20));
    if (length(precise(origin) - precise(target.center)) >= Precise(radius) * Precise(1 - 1e-6))
      continue; // rounding took it to the surface
    RtslState state;
    if (!target.meet(origin, direction, state))
      worst.wrong("missed: " + target.show(origin, direction));
    else
      worst.add(offTheSphere(target, origin, direction, state.HitDistance), [&] { return target.show(origin, direction); });
  }
  return worst.outcome();
}

/// Rays that leave a point of the surface: outwards they meet nothing, inwards the other side.
Outcome runSurface(FloatingPoint floatingPoint, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  Sphere &target = sphere(floatingPoint);
  for (std::uint64_t i = 0; i < cases; ++i) {
    const float radius = powerOfTen(random, -6, 6), distance = std::min(1e7f, radius * powerOfTen(random, 0.2f, 3));
    target.place(random.inBox(10 * radius), radius);
    const Ray ray = aimedFrom(random, target, distance, radius * random.between(0, 0.99f));
    RtslState state, again;
    if (!target.meet(ray.origin, ray.direction, state))
      continue;
    state.instance = 0;
    target.describe(state);
    const Vec3 point = device::load(state.HitPoint), direction = random.direction() * std::ldexp(1.0f, random.integer(-20, 20));
    const float cosine = device::dot(device::normalized(direction), device::normalized(device::load(state.GeometricNormal)));
    // Inwards the chord, 2 r |cosine|, must be longer than what epsilon skips, 1.74 error / |cosine|.
    if (cosine * cosine < 2 * state.hitPointError / radius || std::fabs(cosine) < 2 * device::smallestCosine)
      continue;
    const bool meets = target.meet(point, direction, again, device::spawnEpsilon(state, point, direction));
    worst.count(meets != (cosine < 0), [&] { return target.show(point, direction); });
  }
  return worst.outcome();
}

double nanosecondsAMeeting(FloatingPoint floatingPoint) {
  Sphere &target = sphere(floatingPoint);
  target.place({0, 0, 0}, 1);
  constexpr int count = 1'000'000;
  return timeOf(count, [&] {
    float sum = 0;
    RtslState state;
    for (int i = 0; i < count; ++i) {
      target.meet({0.001f * float(i & 255), 0.25f, 5}, {0, 0, -1}, state);
      sum += state.HitDistance;
    }
    return sum;
  });
}

} // namespace

std::vector<Row> sphereRows(FloatingPoint floatingPoint) {
  const auto row = [&](const char *name, const char *description, const char *unit, std::uint64_t cases, auto run) {
    return Row{name, description, unit, cases, [=](std::uint64_t n, std::uint32_t seed) { return run(floatingPoint, n, seed); },
               [=] { return nanosecondsAMeeting(floatingPoint); }};
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
