#include "scenefile/mistakes/DarkLights.h"

#include "scenefile/mistakes/Members.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <utility>

namespace rtsl::scene {

namespace {

Vector operator-(const Vector &a, const Vector &b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

std::optional<std::string> whyRound(const Members &light) {
  if (light.value<float>("radius") != 0)
    return std::nullopt;
  return "its radius is 0";
}

std::optional<std::string> whyMesh(const Members &light) {
  const std::size_t vertices = light.elements("vertices").count,
                    given = light.elements("triangles").count, count = given ? given : vertices / 3;
  for (std::size_t i = 0; i < count; ++i) {
    std::array<std::uint32_t, 3> corners{};
    for (std::uint32_t k = 0; k < 3; ++k)
      corners[k] = std::uint32_t(3 * i + k);
    if (given)
      corners = light.value<std::array<std::uint32_t, 3>>("triangles", i);
    if (std::any_of(corners.begin(), corners.end(),
                    [&](std::uint32_t corner) { return corner >= vertices; }))
      return std::nullopt; // reported where the shader reads it
    const auto first = light.value<Vector>("vertices", corners[0]);
    if (!isFlat(light.value<Vector>("vertices", corners[1]) - first,
                light.value<Vector>("vertices", corners[2]) - first))
      return std::nullopt;
  }
  return count ? "all of its triangles are lines or points" : "it has no triangles";
}

/// Why a light whose light comes from an area has none.
std::optional<std::string> whyWithoutArea(const Members &light) {
  if (light.is("SphereLight") && light.has("radius", "float") && light.has("radiance", "color"))
    return whyRound(light);
  if (!light.is("AreaLight"))
    return std::nullopt;
  if (light.is("DiskLight") && light.has("radius", "float"))
    return whyRound(light);
  if (light.is("RectangleLight") && light.has("side1", "vec3") && light.has("side2", "vec3"))
    return whyFlat(light.value<Vector>("side1"), light.value<Vector>("side2"));
  if (light.is("MeshLight") && light.has("vertices", "vec3[]") && light.has("triangles", "ivec3[]"))
    return whyMesh(light);
  return std::nullopt;
}

/// Why a light that has a direction shines in none.
std::optional<std::string> whyWithoutDirection(const Members &light) {
  constexpr std::pair<const char *, const char *> directions[] = {{"DistantLight", "direction"},
                                                                  {"SpotLight", "direction"},
                                                                  {"DiskLight", "normal"},
                                                                  {"SunLight", "toSun"}};
  for (const auto &[className, member] : directions)
    if (light.is(className) && light.has(member, "vec3") && light.value<Vector>(member) == Vector{})
      return fmt::format("its `{}` is 0", member);
  if (light.is("SpotLight") && light.has("angle", "float") && light.value<float>("angle") == 0)
    return "its `angle` is 0";
  return std::nullopt;
}

} // namespace

std::optional<std::string> whyDark(const runtime::Scene &scene, RtslRef reference) {
  const Members light(scene, reference);
  if (const std::optional<std::string> why = whyWithoutArea(light))
    return "it has no area: " + *why;
  return whyWithoutDirection(light);
}

} // namespace rtsl::scene
