#include "scenefile/mistakes/InvisibleObjects.h"

#include "scenefile/mistakes/Members.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace rtsl::scene {

namespace {

using Why = std::optional<std::string>;

bool isZero(const Members &object, const char *name) {
  return object.value<Vector>(name) == Vector{};
}

/// The third of the axes along which a primitive is. A constructor normalises it; 0 remains 0.
bool hasAxis(const Members &object) {
  return object.value<std::array<Vector, 3>>("axes")[2] != Vector{};
}

/// Rays are compared with the square of a radius.
Why whySquare(float radius) {
  const float square = radius * radius;
  if (std::isinf(square))
    return fmt::format("the square of its radius, {:g}, is too large for a float", radius);
  if (square == 0 && radius != 0)
    return fmt::format("the square of its radius, {:g}, is 0 as a float", radius);
  return std::nullopt;
}

Why whyCone(const Members &cone) {
  const float radius = std::max(cone.value<float>("radius0"), cone.value<float>("radius1"));
  return radius == 0 ? "its radii are 0" : whySquare(radius);
}

Why whyCurve(const Members &curve) {
  for (std::size_t i = 0; i < curve.elements("points").count; ++i)
    if (curve.value<std::array<float, 4>>("points", i)[3] > 0)
      return std::nullopt;
  return "none of its `points` has a radius above 0";
}

Why whyDisk(const Members &disk) {
  if (!hasAxis(disk))
    return "its `normal` is 0";
  return disk.value<float>("inner") < disk.value<float>("outer")
             ? Why()
             : "its `hole` is as large as its `radius`";
}

Why whyHeightField(const Members &field) {
  const auto low = field.value<Vector>("low"), high = field.value<Vector>("high");
  for (const std::size_t axis : {0, 2}) // without height it is a rectangle
    if (low[axis] == high[axis])
      return fmt::format("`low` and `high` of its box are equal along {}", "xyz"[axis]);
  return std::nullopt;
}

/// The surface is where a form, which is 0 at the centre, has the value `level`; of the form's
/// values in the box the corners have the largest or the least.
Why whyQuadric(const Members &quadric) {
  const auto coefficients = quadric.value<Vector>("coefficients"),
             extent = quadric.value<Vector>("extent");
  const double level = quadric.value<float>("level");
  double least = 0, largest = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double atSide = double(coefficients[axis]) * extent[axis] * extent[axis];
    least += std::min(atSide, 0.0);
    largest += std::max(atSide, 0.0);
  }
  if (least == largest)
    return "its `coefficients` are 0";
  if (level <= least || level >= largest)
    return fmt::format("in its box the form is between {:g} and {:g}, and `level` is {:g}", least,
                       largest, level);
  return std::nullopt;
}

Why whyParallelogram(const Members &parallelogram) {
  return whyFlat(parallelogram.value<Vector>("side1"), parallelogram.value<Vector>("side2"));
}

Why whyPinholeCamera(const Members &camera) {
  if (!isZero(camera, "across") || !isZero(camera, "upward"))
    return std::nullopt;
  return isZero(camera, "corner")
             ? "its `gaze` is 0"
             : "its rays are all the same, because `up` is 0 or along `gaze`, or `uv0` is `uv1`";
}

struct Check {
  const char *className;
  std::vector<std::pair<const char *, const char *>> members; // that it reads, and their types
  Why (*why)(const Members &);
};

const std::vector<Check> &checks() {
  static const std::vector<Check> all = {
      {"Sphere",
       {{"radius", "float"}},
       [](const Members &sphere) { return whySquare(sphere.value<float>("radius")); }},
      {"Capsule",
       {{"distance", "float"}},
       [](const Members &capsule) { return whySquare(capsule.value<float>("distance")); }},
      {"Cone", {{"radius0", "float"}, {"radius1", "float"}}, whyCone},
      {"Curve", {{"points", "vec4[]"}}, whyCurve},
      {"Disk", {{"axes", "mat3"}, {"inner", "float"}, {"outer", "float"}}, whyDisk},
      {"HeightField", {{"low", "vec3"}, {"high", "vec3"}}, whyHeightField},
      {"Parallelogram", {{"side1", "vec3"}, {"side2", "vec3"}}, whyParallelogram},
      {"Quadric", {{"coefficients", "vec3"}, {"extent", "vec3"}, {"level", "float"}}, whyQuadric},
      {"Torus",
       {{"axes", "mat3"}},
       [](const Members &torus) { return hasAxis(torus) ? Why() : "its `axis` is 0"; }},
      {"ViewCamera",
       {{"forward", "vec3"}},
       [](const Members &camera) {
         return isZero(camera, "forward") ? "`eye` and `target` are one point" : Why();
       }},
      {"PinholeCamera",
       {{"corner", "vec3"}, {"across", "vec3"}, {"upward", "vec3"}},
       whyPinholeCamera},
  };
  return all;
}

} // namespace

std::optional<std::string> whyInvisible(const runtime::Scene &scene, RtslRef reference) {
  const Members object(scene, reference);
  for (const Check &check : checks())
    if (object.is(check.className) &&
        std::all_of(check.members.begin(), check.members.end(),
                    [&](const auto &member) { return object.has(member.first, member.second); }))
      return check.why(object);
  return std::nullopt;
}

std::optional<std::string> whyInvisible(const runtime::Mesh &mesh) {
  const auto vertex = [&](std::size_t number) {
    const float *at = mesh.positions.data() + 3 * number;
    return Vector{at[0], at[1], at[2]};
  };
  const auto side = [&](const Vector &from, const Vector &to) {
    return Vector{to[0] - from[0], to[1] - from[1], to[2] - from[2]};
  };
  for (std::size_t key = 0; key < mesh.keyCount(); ++key)
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      const std::size_t first = key * mesh.vertexCount();
      const Vector a = vertex(first + mesh.indices[i]);
      if (!whyFlat(side(a, vertex(first + mesh.indices[i + 1])),
                   side(a, vertex(first + mesh.indices[i + 2]))))
        return std::nullopt;
    }
  return "none of its triangles has an area";
}

std::optional<float> reachesTooFar(const runtime::Scene &scene, RtslRef primitive,
                                   std::uint32_t instance) {
  const Members object(scene, primitive);
  if (std::none_of(checks().begin(), checks().end(),
                   [&](const Check &check) { return object.is(check.className); }))
    return std::nullopt;
  const runtime::Bounds bounds = scene.instanceBounds(instance);
  float reach = 0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    reach = std::max({reach, std::abs(bounds.lower[axis]), std::abs(bounds.upper[axis])});
  return reach > farthest && std::isfinite(reach) ? std::optional(reach) : std::nullopt;
}

} // namespace rtsl::scene
