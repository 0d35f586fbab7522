//===- QuadricTarget.h - a surface of second degree, and who judges hits --===//
#pragma once

#include "RayTarget.h"
#include "Worst.h"

#include "runtime/device/ray/Spawn.h"

#include <cmath>
#include <limits>
#include <optional>
#include <string>

namespace rtsl::numerics {

/// a x^2 + b y^2 + c z^2 = level around a centre: a sphere too.
class QuadricTarget : public RayTarget {
public:
  using RayTarget::RayTarget;
  virtual ~QuadricTarget() = default;

  PreciseVec3 gradient(const PreciseVec3 &p) const {
    return {Precise(coefficients.x) * p[0], Precise(coefficients.y) * p[1],
            Precise(coefficients.z) * p[2]};
  }
  /// a p.x q.x + b p.y q.y + c p.z q.z.
  Precise form(const PreciseVec3 &p, const PreciseVec3 &q) const { return dot(gradient(p), q); }
  PreciseVec3 fromCenter(device::Vec3 point) const { return precise(point) - precise(center); }
  /// Whether the point is inside by more than this share of the level.
  bool isInside(device::Vec3 point, double margin) const {
    const PreciseVec3 f = fromCenter(point);
    return form(f, f) < level * Precise(1 - margin);
  }

  /// Rays from outside: the hit point, where there is one.
  void judgePoint(const Ray &ray, Worst &worst) const {
    if (const auto t = meet(ray.origin, ray.direction))
      worst.add(offTheSurface(ray, *t), [&] { return show(ray); });
  }
  /// Rays from inside of an ellipsoid: all of them meet it.
  void judgeInside(const Ray &ray, Worst &worst) const {
    if (const auto t = meet(ray.origin, ray.direction))
      worst.add(offTheSurface(ray, *t), [&] { return show(ray); });
    else
      worst.wrong("missed: " + show(ray));
  }
  /// How near to the centre of an ellipsoid the line passes, when the ellipsoid is scaled to a
  /// sphere of radius 1.
  Precise passing(const Ray &ray) const {
    const PreciseVec3 f = fromCenter(ray.origin), d = precise(ray.direction);
    const PreciseVec3 nearest = along(f, -form(f, d) / form(d, d), d);
    return sqrt(form(nearest, nearest) / level);
  }
  /// Ellipsoids: is a ray told rightly whether it meets one? What `passing` says moves by at most a
  /// shortest half axis' inverse when the ray moves by 1. In rounding units of the distance;
  /// nothing is wrong with an answer that is right.
  void judgeSilhouette(const Ray &ray, float shortestAxis, Worst &worst) const {
    const bool isHit = meet(ray.origin, ray.direction).has_value();
    const Precise passes = passing(ray), distance = length(fromCenter(ray.origin));
    const bool isWrong = isHit != (passes < 1);
    worst.add(isWrong ? static_cast<double>(abs(passes - 1) * Precise(shortestAxis) /
                                            (distance * Precise(0x1p-24)))
                      : 0,
              [&] { return show(ray); });
  }
  /// A ray that leaves the point of an ellipsoid where `ray` met it: outwards it meets nothing,
  /// inwards the other side.
  void judgeLeaving(const Ray &ray, device::Vec3 onwards, Worst &worst) const {
    const auto t = meet(ray.origin, ray.direction);
    if (!t)
      return;
    const device::Vec3 point = pointAt(ray, *t);
    const PreciseVec3 f = fromCenter(point), d = precise(onwards), normal = gradient(f);
    const double cosine = static_cast<double>(dot(normal, d) / (length(normal) * length(d)));
    // Inwards the chord must be longer than what epsilon skips, 1.74 error / |cosine|.
    const Precise chord = 2 * abs(form(f, d)) / form(d, d) * length(d);
    const double error = device::primitivePointError(ray.origin, ray.direction, *t);
    if (static_cast<double>(chord) < 4 * error / std::fabs(cosine) ||
        std::fabs(cosine) < 2 * device::smallestCosine)
      return;
    worst.count(meetsAgain(ray.origin, ray.direction, onwards) != (cosine < 0),
                [&] { return show({point, onwards}); });
  }

  device::Vec3 center{};

protected:
  virtual std::string show(const Ray &ray) const = 0;

  device::Vec3 coefficients{1, 1, 1};
  Precise level = 1;

private:
  /// How far a ray's point is from the surface, in rounding units of the largest coordinates of the
  /// ray and of the centre, whose difference is rounded: the step to where a form with this value,
  /// slope and largest curvature is 0. But for a cone's apex, where the slope ends, that is value /
  /// slope.
  double offTheSurface(const Ray &ray, float t) const {
    const PreciseVec3 point =
        along(precise(ray.origin), Precise(t), precise(ray.direction)) - precise(center);
    const Precise value = abs(form(point, point) - level), slope = 2 * length(gradient(point));
    const Precise curvature = device::largest(coefficients);
    const Precise distance =
        value == 0 ? Precise(0)
                   : Precise(2 * value / (slope + sqrt(slope * slope + 4 * curvature * value)));
    const Precise ofCenter = Precise(0x1p-24) * Precise(device::largest(center));
    return static_cast<double>(distance / (pointUnit(ray, t) + ofCenter));
  }
};

} // namespace rtsl::numerics
