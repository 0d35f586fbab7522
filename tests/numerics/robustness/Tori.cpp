//===- Tori.cpp - a surface of degree 4, and rays that leave it -----------===//
//
// The oracle is Sturm's theorem in MPFR: it counts where a ray meets a torus, and rounds nothing.
//
//===----------------------------------------------------------------------===//
#include "RayTarget.h"
#include "Row.h"
#include "Timing.h"
#include "Worst.h"

#include "runtime/device/ray/Spawn.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace rtsl::numerics {

namespace {

using device::Vec3;

/// A polynomial, the constant term first.
using Polynomial = std::vector<Precise>;

Polynomial operator*(const Polynomial &a, const Polynomial &b) {
  Polynomial product(a.size() + b.size() - 1, Precise(0));
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < b.size(); ++j)
      product[i + j] += a[i] * b[j];
  return product;
}

/// How often the signs of Sturm's chain change at x.
class SturmChain {
public:
  explicit SturmChain(Polynomial first) {
    Polynomial second;
    for (std::size_t i = 1; i < first.size(); ++i)
      second.push_back(first[i] * static_cast<unsigned>(i));
    chain = {std::move(first), std::move(second)};
    while (chain.back().size() > 1) {
      Polynomial rest = remainder(chain[chain.size() - 2], chain.back());
      for (Precise &one : rest)
        one = -one;
      if (rest.empty())
        break;
      chain.push_back(std::move(rest));
    }
  }
  /// Roots in (low, high].
  int rootsBetween(const Precise &low, const Precise &high) const {
    return changesAt(low) - changesAt(high);
  }

private:
  static Polynomial remainder(Polynomial a, const Polynomial &b) {
    while (a.size() >= b.size()) {
      const Precise factor = a.back() / b.back();
      for (std::size_t i = 0; i < b.size(); ++i)
        a[a.size() - b.size() + i] -= factor * b[i];
      a.pop_back();
    }
    while (!a.empty() && a.back() == 0)
      a.pop_back();
    return a;
  }
  int changesAt(const Precise &x) const {
    int changes = 0, sign = 0;
    for (const Polynomial &one : chain) {
      Precise value = 0;
      for (auto part = one.rbegin(); part != one.rend(); ++part)
        value = value * x + *part;
      const int here = value > 0 ? 1 : value < 0 ? -1 : 0;
      changes += here != 0 && sign != 0 && here != sign;
      sign = here != 0 ? here : sign;
    }
    return changes;
  }

  std::vector<Polynomial> chain;
};

class Torus : public RayTarget {
public:
  Torus(const char *file, const char *className, Path path)
      : RayTarget(file, className, {{"ring", targetRoom / 2}, {"tube", targetRoom / 4}}, path) {}

  void place(Vec3 at, float theRing, float theTube) {
    center = at;
    ring = theRing;
    tube = theTube;
    set("center", {at.x, at.y, at.z});
    set("ring", {ring});
    set("tube", {tube});
  }
  float size() const { return ring + tube; }

  /// (|p|^2 + R^2 - r^2)^2 - 4 R^2 (x^2 + y^2) along a ray.
  SturmChain along(Vec3 origin, Vec3 direction) const {
    const PreciseVec3 o = precise(origin) - precise(center), d = precise(direction);
    const Precise R = ring, r = tube;
    const Polynomial square = {dot(o, o) + R * R - r * r, 2 * dot(o, d), dot(d, d)};
    const Polynomial x = {o[0], d[0]}, y = {o[1], d[1]};
    Polynomial result = square * square;
    const Polynomial xx = x * x, yy = y * y;
    for (std::size_t i = 0; i < xx.size(); ++i)
      result[i] -= 4 * R * R * (xx[i] + yy[i]);
    return SturmChain(std::move(result));
  }
  /// Outwards, of any length.
  PreciseVec3 normalAt(Vec3 point) const {
    const PreciseVec3 p = precise(point) - precise(center);
    const Precise share = 1 - Precise(ring) / sqrt(p[0] * p[0] + p[1] * p[1]);
    return {p[0] * share, p[1] * share, p[2]};
  }
  double cosine(Vec3 point, Vec3 direction) const {
    const PreciseVec3 normal = normalAt(point), d = precise(direction);
    return static_cast<double>(dot(normal, d) / (length(normal) * length(d)));
  }
  std::string text() const {
    return fmt::format("center {}, ring {:a}, tube {:a}", show(center), ring, tube);
  }

  Vec3 center{};
  float ring = 2, tube = 0.5f;
};

/// Of a program there is one.
Torus &ferrari(Path path) {
  static Torus only("tests/numerics/robustness/shaders/FerrariTorus.rtsl", "FerrariTorus", path);
  return only;
}
Torus &stepped(Path path) {
  static Torus only("tests/numerics/robustness/shaders/SteppedTorus.rtsl", "SteppedTorus", path);
  return only;
}

Ray placeAndAim(Random &random, Torus &target) {
  const float ring = powerOfTen(random, -3, 3);
  target.place(random.inBox(2 * ring), ring, ring * random.between(0.1f, 0.6f));
  return aimedFrom(random, target.center, target.size(),
                   target.size() * powerOfTen(random, 0.3f, 1),
                   target.size() * random.between(0, 1));
}

/// Rays that leave outwards and meet the torus nowhere further on: those that meet it near where
/// they start have met what they leave. Far away they may graze it by a rounding.
Outcome judgeSelfHits(Torus &target, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  for (std::uint64_t i = 0; i < cases; ++i) {
    const Ray ray = placeAndAim(random, target);
    const Vec3 onwards = random.direction() * std::ldexp(1.0f, random.integer(-10, 10));
    if (!target.meet(ray.origin, ray.direction))
      continue;
    const Vec3 point = target.hitPoint(ray.origin, ray.direction);
    if (target.cosine(point, onwards) < 2 * device::smallestCosine)
      continue; // inwards, or where the bound is given up (runtime/device/ray/Spawn.h)
    const Precise size = target.size(), speed = length(precise(onwards));
    if (target.along(point, onwards).rootsBetween(size / 1000 / speed, 100 * size / speed) == 0)
      worst.count(target.meetsWithin(static_cast<float>(size / 10 / speed), ray.origin,
                                     ray.direction, onwards),
                  [&] { return target.text() + ", " + ray.text() + ", onwards " + show(onwards); });
  }
  return worst.outcome();
}

/// What a ray skips that leaves straight inwards, in rounding units of the largest coordinate of
/// the ray that met the torus.
Outcome judgeGaps(Torus &target, std::uint64_t cases, std::uint32_t seed, double cosine) {
  Random random(seed);
  Worst worst;
  for (std::uint64_t i = 0; i < cases; ++i) {
    const Ray ray = placeAndAim(random, target);
    const auto t = target.meet(ray.origin, ray.direction);
    if (!t)
      continue;
    const Vec3 point = target.hitPoint(ray.origin, ray.direction);
    if (std::fabs(target.cosine(point, ray.direction)) < cosine)
      continue;
    const PreciseVec3 normal = target.normalAt(point);
    const Precise scale = -1 / length(normal);
    const Vec3 inwards = {static_cast<float>(normal[0] * scale),
                          static_cast<float>(normal[1] * scale),
                          static_cast<float>(normal[2] * scale)};
    if (const auto gap = target.startOfNext(ray.origin, ray.direction, inwards))
      worst.add(static_cast<double>(Precise(*gap) / pointUnit(ray, *t)),
                [&] { return target.text() + ", " + ray.text(); });
  }
  return worst.outcome();
}

double nanosecondsAMeeting(Path path) {
  Torus &target = ferrari(path);
  target.place({0, 0.25f, 0}, 1, 0.75f);
  return nanosecondsToMeet(target);
}

} // namespace

std::vector<Row> torusRows(Path path) {
  const auto row = rowsOf(path, nanosecondsAMeeting);
  const char *units = "rounding units of the largest coordinate";
  return {
      row("tori.selfHits",
          "a torus by steps, which states its error: rays that leave it outwards for good: those "
          "that meet it again within a tenth of its size",
          "hits", 100'000,
          [](Path on, std::uint64_t cases, std::uint32_t seed) {
            return judgeSelfHits(stepped(on), cases, seed);
          }),
      row("tori.gaps",
          "the same: what a ray skips that leaves straight inwards, where the torus was met at a "
          "cosine above 1/8",
          units, 100'000,
          [](Path on, std::uint64_t cases, std::uint32_t seed) {
            return judgeGaps(stepped(on), cases, seed, 0.125);
          }),
      row("tori.ferrariSelfHits",
          "a torus by Ferrari's quartic, whose error the compiler derives: rays that leave it "
          "outwards for good: those that meet it again within a tenth of its size",
          "hits", 100'000,
          [](Path on, std::uint64_t cases, std::uint32_t seed) {
            return judgeSelfHits(ferrari(on), cases, seed);
          }),
      row("tori.ferrariGaps",
          "the same: what a ray skips that leaves straight inwards, where the torus was met at a "
          "cosine above 1/8",
          units, 100'000,
          [](Path on, std::uint64_t cases, std::uint32_t seed) {
            return judgeGaps(ferrari(on), cases, seed, 0.125);
          }),
  };
}

} // namespace rtsl::numerics
