//===- CameraAndLights.cpp - cameras and punctual lights ------------------===//
#include "scenefile/gltf/Animation.h"
#include "scenefile/gltf/Nodes.h"
#include "scenefile/json/Reader.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace rtsl::scene::gltf {

using Kind = JsonValue::Kind;
using runtime::Transform;

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double degrees = 180 / pi;

/// The field of view of a camera that frames a scene.
constexpr double framingField = 40; // degrees
constexpr double framingFrom[3] = {0.45, 0.35, 0.82};

JsonValue viewCamera(const JsonValue &source, const char *className,
                     const std::array<double, 3> &eye, const std::array<double, 3> &target,
                     const std::array<double, 3> &up, Modules &modules) {
  const auto point = [&](const std::array<double, 3> &p) {
    return numbers(source, {p[0], p[1], p[2]});
  };
  JsonValue camera = libraryObject(source, className, modules);
  set(camera, "constructor",
      object(source, {{"eye", point(eye)}, {"target", point(target)}, {"up", point(up)}}));
  return camera;
}

/// A camera looks along -z of its node, and y is up.
JsonValue placedCamera(const JsonValue &source, const char *className, const Transform &place,
                       Modules &modules) {
  std::array<double, 3> target = place.columns[3];
  for (std::size_t i = 0; i < 3; ++i)
    target[i] -= place.columns[2][i];
  return viewCamera(source, className, place.columns[3], target, place.columns[1], modules);
}

double above0(const JsonValue &object, const char *key, const std::string &what) {
  const JsonValue &found = require(object, key, what);
  const double value = readNumber(found, fmt::format("`{}` of {}", key, what));
  if (value <= 0)
    throw Error(message::notAboveZero(key, what, value), found.place());
  return value;
}

JsonValue cameraAt(const JsonValue &camera, std::size_t index, const Transform &place,
                   const JsonValue &source, Modules &modules) {
  const std::string what = fmt::format("`cameras.{}`", index);
  const JsonValue &type = expect(require(camera, "type", what), Kind::String, "`type` of " + what);
  if (type.string == "perspective") {
    const JsonValue &lens =
        expect(require(camera, "perspective", what), Kind::Object, "`perspective` of " + what);
    JsonValue made = placedCamera(source, "cameras.PerspectiveCamera", place, modules);
    const double field = above0(lens, "yfov", what);
    if (field >= pi)
      throw Error(message::fieldOfViewTooWide(what, field), lens.find("yfov")->place());
    set(made, "fieldOfView", number(lens, field * degrees));
    return made;
  }
  if (type.string == "orthographic") {
    const JsonValue &lens =
        expect(require(camera, "orthographic", what), Kind::Object, "`orthographic` of " + what);
    JsonValue made = placedCamera(source, "cameras.OrthographicCamera", place, modules);
    set(made, "height", number(lens, 2 * above0(lens, "ymag", what)));
    return made;
  }
  throw Error(message::badModelCameraType(what, type.string), type.place());
}

JsonValue framing(const File &file, const Animation &animation, const Transform &transform,
                  const JsonValue &source, Modules &modules) {
  const std::optional<Box> box = boxOf(file, animation);
  if (!box)
    throw Error(message::modelWithoutCamera(file.path()), source.place());
  std::array<double, 3> center{};
  double radius = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    center[i] = 0.5 * (box->low[i] + box->high[i]);
    const double half = 0.5 * (box->high[i] - box->low[i]);
    radius += half * half;
  }
  radius = std::max(std::sqrt(radius), 1e-6);
  const double distance = radius / std::sin(0.5 * framingField / degrees);
  Transform place; // columns 1 to 3 are up, backward and the eye
  for (std::size_t i = 0; i < 3; ++i) {
    place.columns[2][i] = distance * framingFrom[i];
    place.columns[3][i] = center[i] + distance * framingFrom[i];
  }
  JsonValue made =
      placedCamera(source, "cameras.PerspectiveCamera", place.then(transform), modules);
  set(made, "fieldOfView", number(source, framingField));
  return made;
}

} // namespace

JsonValue cameraOf(const File &file, const Animation &animation, const std::string &name,
                   const Transform &transform, const JsonValue &source, Modules &modules) {
  std::vector<std::string> names;
  for (const Node &node : nodesOf(file, animation)) {
    const JsonValue *number = node.json->find("camera");
    if (!number)
      continue;
    const std::size_t index = file.index("cameras", *number, "`camera` of " + node.what);
    const JsonValue &camera = file.list("cameras")[index];
    if (name.empty() || nameOf(camera) == name || nameOf(*node.json) == name)
      return cameraAt(camera, index, node.toWorld.then(transform), source, modules);
    names.push_back(nameOf(camera).empty() ? nameOf(*node.json) : nameOf(camera));
  }
  if (name.empty())
    return framing(file, animation, transform, source, modules);
  Error error(message::noSuchModelCamera(file.path(), name), source.place());
  names.erase(std::remove(names.begin(), names.end(), std::string()), names.end());
  if (!names.empty())
    error.note(fmt::format("it has `{}`", fmt::join(names, "`, `")));
  throw error;
}

/// Candela and lux are of radiation that falls on a surface; our lights give the radiance of a
/// white surface, which is a pi-th of it.
JsonValue lightOf(const File &file, const JsonValue &lightNumber, const std::string &user,
                  Modules &modules, std::vector<Warning> &warnings) {
  const std::size_t index = file.index("lights", lightNumber, "`light` of " + user);
  const JsonValue &json = file.lights()[index];
  const std::string what = fmt::format("`lights.{}`", index);
  const auto read = [&](const JsonValue &from, const char *key, double otherwise, double most) {
    const JsonValue *found = from.find(key);
    if (!found)
      return otherwise;
    const double value = readNumber(*found, fmt::format("`{}` of {}", key, what));
    if (value < 0 || value > most)
      throw Error(message::keyNotBetweenZeroAnd(key, what, most, value), found->place());
    return value;
  };
  std::vector<double> color(3, 1.0);
  if (const JsonValue *found = json.find("color"))
    color = readNumbers(*found, 3, "`color` of " + what);
  const double intensity = read(json, "intensity", 1, 1e30);
  for (double &one : color)
    one *= intensity / pi;
  if (const JsonValue *range = json.find("range"))
    warnings.push_back({message::lightRangeIgnored(what), range->place()});
  const JsonValue &type = expect(require(json, "type", what), Kind::String, "`type` of " + what);
  if (type.string == "point") {
    JsonValue light = libraryObject(json, "lights.PointLight", modules);
    set(light, "intensity", numbers(json, color));
    return light;
  }
  if (type.string == "directional") {
    JsonValue light = libraryObject(json, "lights.DistantLight", modules);
    set(light, "direction", numbers(json, {0, 0, 1}));
    set(light, "irradiance", numbers(json, color));
    return light;
  }
  if (type.string != "spot")
    throw Error(message::badModelLightType(what, type.string), type.place());
  const JsonValue &cone = expect(require(json, "spot", what), Kind::Object, "`spot` of " + what);
  const double outer = read(cone, "outerConeAngle", pi / 4, pi / 2);
  const double inner = read(cone, "innerConeAngle", 0, outer);
  JsonValue light = libraryObject(json, "lights.SpotLight", modules);
  set(light, "direction", numbers(json, {0, 0, -1}));
  set(light, "angle", number(cone, outer * degrees));
  set(light, "softness", number(cone, outer > 0 ? 1 - inner / outer : 0));
  set(light, "intensity", numbers(json, color));
  return light;
}

} // namespace rtsl::scene::gltf
