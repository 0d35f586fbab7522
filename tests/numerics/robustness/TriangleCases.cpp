//===- TriangleCases.cpp --------------------------------------------------===//
#include "TriangleCases.h"

#include <cmath>
#include <limits>

namespace rtsl::numerics {

namespace {

using device::Vec3;

Triangle triangleIn(Random &random, float size) {
  return {{random.inBox(size), random.inBox(size), random.inBox(size)}};
}
Vec3 middleOf(const Triangle &triangle) {
  return (triangle.v[0] + triangle.v[1] + triangle.v[2]) * (1 / 3.0f);
}

/// Sides of 11, 9.7 and 1.4, in a random frame, half a degree above the plane.
TriangleCase sliver(Random &random, std::uint64_t) {
  const Vec3 x = random.direction(), y = device::normalized(device::cross(x, random.direction())),
             n = device::cross(x, y);
  constexpr float along = (11.0f * 11.0f + 9.7f * 9.7f - 1.4f * 1.4f) / (2 * 11.0f);
  const float across = std::sqrt(9.7f * 9.7f - along * along);
  const Vec3 origin = random.inBox(100);
  const Triangle triangle = {{origin, origin + x * 11.0f, origin + x * along + y * across}};
  const float u = random.between(0.05f, 0.9f), v = random.between(0.02f, 0.95f - u);
  const Vec3 target = triangle.v[0] * (1 - u - v) + triangle.v[1] * u + triangle.v[2] * v;
  const float angle = random.between(0, 6.2831853f), rise = 0.0087266462f;
  const Vec3 direction = x * std::cos(angle) + y * std::sin(angle) + n * rise;
  const float distance = random.between(1, 100);
  return {{target - direction * distance, direction}, triangle, 1e-3};
}

TriangleCase scaled(Random &random, std::uint64_t number) {
  const float size = number % 2 ? 1e8f : 1e-8f;
  const Triangle triangle = triangleIn(random, size);
  const Vec3 origin = random.inBox(3 * size);
  return {
      {origin, number % 4 < 2 ? random.direction() : middleOf(triangle) - origin}, triangle, 1e-2};
}

TriangleCase thinlyAimed(Random &random, std::uint64_t) {
  const float tiny[] = {0.0f, -0.0f, 1e-40f, -1e-40f, 1e-30f, -1e-30f};
  float direction[3];
  for (float &component : direction)
    component = tiny[random.index(6)];
  direction[random.index(3)] = random.between(0.5f, 1) * (random.index(2) ? 1 : -1);
  const Vec3 d = device::load(direction);
  const Triangle triangle = triangleIn(random, 2);
  return {{middleOf(triangle) - d * random.between(1, 5), d}, triangle, 1e-3};
}

TriangleCase ofExtremeLength(Random &random, std::uint64_t number) {
  const Triangle triangle = triangleIn(random, 2);
  const Vec3 origin = random.inBox(5);
  const float length = number % 2 ? 1e20f : 1e-20f;
  return {{origin, (middleOf(triangle) - origin) * length}, triangle, 1e-3};
}

/// In an axis' plane, so that its box has no thickness; the origin often lies in the planes of the
/// box's other sides.
TriangleCase flat(Random &random, std::uint64_t) {
  const int axis = random.integer(0, 2);
  const float height = random.between(-2, 2);
  Triangle triangle;
  for (Vec3 &vertex : triangle.v) {
    float coordinates[] = {random.between(-2, 2), random.between(-2, 2), random.between(-2, 2)};
    coordinates[axis] = height;
    vertex = device::load(coordinates);
  }
  const Vec3 target = middleOf(triangle);
  float origin[3];
  for (int i = 0; i < 3; ++i) {
    // Above the target itself the direction's component is 0, or nearly.
    const float choices[] = {target[i], triangle.v[random.index(3)][i], random.between(-5, 5)};
    origin[i] = i == axis ? height + random.between(1, 5) * (random.index(2) ? 1.0f : -1.0f)
                          : choices[random.index(3)];
  }
  return {{device::load(origin), target - device::load(origin)}, triangle, 1e-3};
}

double distanceFromPlane(const TriangleCase &given, float t, const Rational &truth) {
  if (!std::isfinite(t))
    return std::numeric_limits<double>::infinity();
  const double alongRay = (exact(t) - truth).convert_to<double>();
  const auto &[v0, v1, v2] = given.triangle.v;
  double edges[2][3], normal[3], reach = 0, along = 0, length = 0;
  for (int i = 0; i < 3; ++i) {
    edges[0][i] = double(v1[i]) - v0[i];
    edges[1][i] = double(v2[i]) - v0[i];
    for (const Vec3 &vertex : given.triangle.v)
      reach = std::max(reach, std::abs(double(vertex[i]) - given.ray.origin[i]));
  }
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    normal[i] = edges[0][j] * edges[1][k] - edges[0][k] * edges[1][j];
    along += normal[i] * given.ray.direction[i];
    length = std::hypot(length, normal[i]);
  }
  return std::abs(alongRay * along / length) / (device::roundingUnit * reach);
}

} // namespace

const std::vector<TriangleKind> &triangleKinds() {
  static const std::vector<TriangleKind> kinds = {
      {"slivers", "sides 11, 9.7 and 1.4, seen at half a degree", sliver},
      {"scales", "vertices at 1e8 and 1e-8", scaled},
      {"directions", "direction components of 0, -0, 1e-40 and 1e-30", thinlyAimed},
      {"lengths", "directions of length 1e20 and 1e-20", ofExtremeLength},
      {"flat",
       "triangles whose boxes have no thickness, rays along the axes and from the planes of the "
       "box's sides",
       flat},
  };
  return kinds;
}

TriangleCase degenerateTriangle(Random &random, std::uint64_t number) {
  const Vec3 a = random.inBox(4), b = random.inBox(4);
  const float half = 0.5f;
  Triangle triangle = {{a, b, b}};
  switch (number % 4) {
  case 1:
    triangle = {{a, a, a}};
    break;
  case 2:
    triangle = {{a, a + (b - a) * half, b}};
    break;
  case 3:
    triangle = {{a, {a.x + 1, a.y, a.z}, {a.x + 2, a.y, a.z}}};
    break;
  default:
    break;
  }
  const Vec3 origin = random.inBox(8);
  const Vec3 target =
      number % 3 ? triangle.v[0] + (triangle.v[2] - triangle.v[0]) * half : random.inBox(4);
  return {{origin, target - origin}, triangle, 0};
}

void judgeTriangle(const TriangleCase &given, Asked asked, std::optional<float> t, Worst &worst) {
  const auto &[v0, v1, v2] = given.triangle.v;
  const ExactHit truth = intersectExactly(given.ray.origin, given.ray.direction, v0, v1, v2);
  if (truth.determinant == 0)
    return;
  const double weight = truth.smallestWeight().convert_to<double>();
  if (std::abs(weight) < given.clear)
    return;
  if (t.has_value() != (weight > 0 && (asked == Asked::Line || truth.t > 0)))
    worst.wrong(given.text());
  else if (t)
    worst.add(distanceFromPlane(given, *t, truth.t), [&] { return given.text(); });
}

double pointOffPlane(const Triangle &triangle, Vec3 point) {
  const ExactVec3 base(triangle.v[0]),
      normal = cross(ExactVec3(triangle.v[1]) - base, ExactVec3(triangle.v[2]) - base);
  const Rational square = dot(normal, normal), along = dot(normal, ExactVec3(point) - base);
  if (square == 0)
    return 0;
  const Rational ratio = along * along / square; // of the distance's square: only this is rounded
  return std::sqrt(ratio.convert_to<double>()) /
         (device::roundingUnit * triangle.largestCoordinate());
}

} // namespace rtsl::numerics
