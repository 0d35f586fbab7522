#include "scenefile/DarkLights.h"

#include "runtime/scene/Elements.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <utility>

namespace rtsl::scene {

using runtime::ClassInfo;
using runtime::Elements;
using runtime::MemberInfo;
using Vector = std::array<float, 3>;

namespace {

Vector operator-(const Vector &a, const Vector &b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

double squareOf(const std::array<double, 3> &a) {
  return a[0] * a[0] + a[1] * a[1] + a[2] * a[2];
}

/// Is the parallelogram with these sides a line or a point, but for the rounding of its sides?
bool isFlat(const Vector &a, const Vector &b) {
  constexpr double rounding = 0x1p-22;
  const std::array<double, 3> from{a[0], a[1], a[2]}, to{b[0], b[1], b[2]};
  std::array<double, 3> normal;
  for (std::size_t i = 0, j = 1, k = 2; i < 3; ++i, j = (j + 1) % 3, k = (k + 1) % 3)
    normal[i] = from[j] * to[k] - from[k] * to[j];
  return squareOf(normal) <= rounding * rounding * squareOf(from) * squareOf(to);
}

/// The members of a light, in its record.
class Light {
public:
  Light(const runtime::Scene &scene, RtslRef light)
      : info(scene.classOf(light)), record(scene.record(light)) {}

  bool is(const char *className) const {
    return info.name == className || info.base == className ||
           std::find(info.ancestors.begin(), info.ancestors.end(), className) !=
               info.ancestors.end();
  }

  /// Whether it has a member of this type.
  bool has(const char *name, const char *type) const {
    const MemberInfo *const member = find(name);
    return member && member->type.name == type;
  }

  Elements elements(const char *name) const {
    const MemberInfo &member = *find(name);
    return runtime::elementsOf(member.type, record + member.offset);
  }

  template <typename Value>
  Value value(const char *name, std::size_t element = 0) const {
    Value value;
    std::memcpy(&value, elements(name)[element], sizeof value);
    return value;
  }

private:
  const MemberInfo *find(const char *name) const {
    const auto found = std::find_if(info.members.begin(), info.members.end(),
                                    [&](const MemberInfo &one) { return one.name == name; });
    return found == info.members.end() ? nullptr : &*found;
  }

  const ClassInfo &info;
  const std::uint8_t *const record;
};

std::optional<std::string> whyParallelogram(const Light &light) {
  const auto one = light.value<Vector>("side1"), other = light.value<Vector>("side2");
  if (!isFlat(one, other))
    return std::nullopt;
  const bool isPoint = one == Vector{} || other == Vector{};
  return isPoint ? "one of its sides is 0" : "its sides are parallel";
}

std::optional<std::string> whyRound(const Light &light) {
  if (light.value<float>("radius") != 0)
    return std::nullopt;
  return "its radius is 0";
}

std::optional<std::string> whyMesh(const Light &light) {
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
std::optional<std::string> whyWithoutArea(const Light &light) {
  if (light.is("SphereLight") && light.has("radius", "float") && light.has("radiance", "color"))
    return whyRound(light);
  if (!light.is("AreaLight"))
    return std::nullopt;
  if (light.is("DiskLight") && light.has("radius", "float"))
    return whyRound(light);
  if (light.is("RectangleLight") && light.has("side1", "vec3") && light.has("side2", "vec3"))
    return whyParallelogram(light);
  if (light.is("MeshLight") && light.has("vertices", "vec3[]") && light.has("triangles", "ivec3[]"))
    return whyMesh(light);
  return std::nullopt;
}

/// Why a light that has a direction shines in none.
std::optional<std::string> whyWithoutDirection(const Light &light) {
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
  const Light light(scene, reference);
  if (const std::optional<std::string> why = whyWithoutArea(light))
    return "it has no area: " + *why;
  return whyWithoutDirection(light);
}

} // namespace rtsl::scene
