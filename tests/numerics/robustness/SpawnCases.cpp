//===- SpawnCases.cpp -----------------------------------------------------===//
#include "SpawnCases.h"

#include <algorithm>
#include <cmath>

namespace rtsl::numerics {

using device::Vec3;

namespace {

Vector difference(Vec3 a, Vec3 b) {
  return {double(a.x) - b.x, double(a.y) - b.y, double(a.z) - b.z};
}
Vector cross(const Vector &a, const Vector &b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double dot(const Vector &a, const Vector &b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Vector pointAlong(Vec3 point, double t, Vec3 direction) {
  return {point.x + t * direction.x, point.y + t * direction.y, point.z + t * direction.z};
}

float lastPlaceOf(float coordinate) {
  return std::ldexp(1.0f, device::exponentOf(coordinate) - 23);
}

} // namespace

Triangle triangleToLeave(Random &random) {
  const float far = std::ldexp(1.0f, random.integer(-10, 10)),
              size = far * std::ldexp(1.0f, random.integer(-18, 0));
  const Vec3 place = random.inBox(far);
  return {{place + random.inBox(size), place + random.inBox(size), place + random.inBox(size)}};
}

Ray rayTowards(Random &random, const Triangle &triangle, int lowest, int highest) {
  const float u = random.between(0, 1), v = random.between(0, 1) * (1 - u);
  const Vec3 point = triangle.v[0] * (1 - u - v) + triangle.v[1] * u + triangle.v[2] * v;
  const float distance =
      triangle.largestCoordinate() * std::ldexp(1.0f, random.integer(lowest, highest));
  const Vec3 origin = point + random.direction() * distance;
  return {origin, point - origin};
}

Plane::Plane(const Triangle &triangle) : base(triangle.v[0]) {
  const Vector e1 = difference(triangle.v[1], base), e2 = difference(triangle.v[2], base);
  normal = cross(e1, e2);
  const double length = std::sqrt(dot(normal, normal));
  isGood = length > 1e-3 * std::sqrt(dot(e1, e1) * dot(e2, e2));
  for (double &component : normal)
    component /= length;
}

double Plane::distance(Vec3 point) const {
  return dot(difference(point, base), normal);
}

double Plane::cosine(Vec3 direction) const {
  const Vector d = difference(direction, {0, 0, 0});
  return dot(d, normal) / std::sqrt(dot(d, d));
}

std::optional<double> crossing(const Triangle &triangle, Vec3 point, Vec3 direction) {
  const Plane plane(triangle);
  const double t = -plane.distance(point) / dot(difference(direction, {0, 0, 0}), plane.normal);
  const Vector there = pointAlong(point, t, direction);
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 from = triangle.v[i], to = triangle.v[(i + 1) % 3], other = triangle.v[(i + 2) % 3];
    const Vector inward = cross(plane.normal, difference(to, from));
    const Vector here = {there[0] - from.x, there[1] - from.y, there[2] - from.z};
    if (!(dot(inward, here) > 0.02 * dot(inward, difference(other, from))))
      return std::nullopt;
  }
  return t;
}

std::optional<Gap> gapAbove(Random &random, const Triangle &triangle, Vec3 point, float side) {
  const Plane floor(triangle);
  if (!floor.isGood)
    return std::nullopt;
  const float height = side * lastPlaceOf(triangle.largestCoordinate()) * random.between(0, 24);
  const Vec3 up = {float(floor.normal[0]), float(floor.normal[1]), float(floor.normal[2])};
  const auto above = [&](int i) { return triangle.v[std::size_t(i)] + up * height; };
  Gap gap{{{above(0), above(1), above(2)}}, point, {}, 0};
  Vec3 direction;
  do
    direction = random.direction();
  while (!(device::dot(direction, up) * side > 0.125f));
  gap.direction = direction * std::ldexp(1.0f, random.integer(-20, 20));

  const std::optional<double> t = crossing(gap.ceiling, gap.point, gap.direction);
  if (!t)
    return std::nullopt;
  const Vector there = pointAlong(gap.point, *t, gap.direction);
  const double wide =
      lastPlaceOf(std::max(triangle.largestCoordinate(), gap.ceiling.largestCoordinate()));
  gap.ulps =
      (dot(there, floor.normal) - (floor.normal[0] * floor.base.x + floor.normal[1] * floor.base.y +
                                   floor.normal[2] * floor.base.z)) *
      side / wide;
  return gap;
}

} // namespace rtsl::numerics
