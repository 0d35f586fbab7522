#include "scenefile/graph/NodeLights.h"

#include "scenefile/json/Reader.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

namespace rtsl::scene {

using runtime::Transform;

namespace {

/// A class of library/std/lights, and its members that a transform changes.
struct PlaceableLight {
  const char *className;
  std::vector<SpatialMember> members;
};

const std::vector<PlaceableLight> &placeableLights() {
  static const std::vector<PlaceableLight> lights = {
      {"DistantLight", {{"direction", false, {0, 1, 0}}}},
      {"PointLight", {{"position", true, {0, 0, 0}}}},
      {"RectangleLight",
       {{"corner", true, {0, 0, 0}},
        {"side1", false, {1, 0, 0}, "side2"},
        {"side2", false, {0, 0, 1}, "side1"}}},
      {"SpotLight", {{"position", true, {0, 0, 0}}, {"direction", false, {0, -1, 0}}}}};
  return lights;
}

/// Throws NotSupported, as requirePlaceable.
const std::vector<SpatialMember> &spatialMembers(const LocatedName &className) {
  std::vector<std::string> names;
  for (const PlaceableLight &light : placeableLights()) {
    if (className.text == light.className)
      return light.members;
    names.emplace_back(light.className);
  }
  throw Error(message::lightClassNotInNode(className.text, fmt::join(names, "`, `")),
              className.place);
}

JsonValue listAt(const Place &place, const std::array<double, 3> &numbers) {
  JsonValue result;
  result.kind = JsonValue::Kind::Array;
  result.file = std::make_shared<const std::string>(place.file);
  result.line = place.line;
  result.column = place.column;
  result.length = place.length;
  for (const double one : numbers) {
    JsonValue number = result;
    number.elements.clear();
    number.kind = JsonValue::Kind::Number;
    number.number = one;
    result.elements.push_back(std::move(number));
  }
  return result;
}

std::array<double, 3> inWorld(const std::vector<double> &value, bool isPoint,
                              const Transform &toWorld) {
  std::array<double, 3> result{};
  for (std::size_t row = 0; row < 3; ++row) {
    result[row] = isPoint ? toWorld.columns[3][row] : 0;
    for (std::size_t column = 0; column < 3; ++column)
      result[row] += toWorld.columns[column][row] * value[column];
  }
  return result;
}

} // namespace

std::vector<PlacedMember>
placedMembers(const LocatedName &className, const Transform &toWorld,
              const std::function<std::vector<double>(const SpatialMember &)> &valueOf) {
  const bool isMirrored = toWorld.determinant() < 0;
  std::vector<PlacedMember> placed;
  for (const SpatialMember &member : spatialMembers(className))
    placed.push_back({isMirrored ? member.ifMirrored : member.name,
                      inWorld(valueOf(member), member.isPoint, toWorld)});
  return placed;
}

void requirePlaceable(const LocatedName &className) {
  spatialMembers(className);
}

ObjectDescription placedLight(const ObjectDescription &light, const runtime::MovingTransform &way,
                              SceneDescription &scene) {
  if (way.moves())
    throw Error(message::movingLight(), light.place);
  const auto own = [](auto &members, const char *name) {
    return std::find_if(members.begin(), members.end(),
                        [&](const auto &member) { return member.first.text == name; });
  };
  const auto valueOf = [&](const SpatialMember &member) {
    const auto found = own(light.members, member.name);
    return found != light.members.end()
               ? readNumbers(*found->second, 3, fmt::format("`{}`", member.name))
               : std::vector<double>(member.otherwise.begin(), member.otherwise.end());
  };
  ObjectDescription placed = light;
  for (const PlacedMember &member : placedMembers(light.className, way.still(), valueOf)) {
    auto found = own(placed.members, member.name);
    if (found == placed.members.end())
      found = placed.members.insert(found, {{member.name, light.place}, nullptr});
    const Place place = found->second ? found->second->place() : light.place;
    scene.placedValues.push_back(std::make_shared<JsonValue>(listAt(place, member.value)));
    found->second = scene.placedValues.back().get();
  }
  return placed;
}

} // namespace rtsl::scene
