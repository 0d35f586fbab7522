#include "scenefile/ModelPart.h"

#include "scenefile/gltf/Parts.h"

#include <utility>
#include <vector>

namespace rtsl::scene {

using gltf::number;
using gltf::numbers;
using gltf::object;
using gltf::set;
using gltf::text;

namespace {

/// An empty value for the position of values that are in no file.
JsonValue nowhere() {
  JsonValue value;
  value.file = std::make_shared<const std::string>();
  return value;
}

/// {"model": path, ...}, as an author writes it.
JsonValue mentionOf(const std::string &path, const ModelPlay &play) {
  const JsonValue source = nowhere();
  JsonValue mention = object(source, {{"model", text(source, path)}});
  if (!play.animation.empty())
    set(mention, "animation", text(source, play.animation));
  if (play.framesPerSecond != 0)
    set(mention, "fps", number(source, play.framesPerSecond));
  return mention;
}

/// Reads a scene with nothing but `key`.
SceneDescription readWith(const char *key, JsonValue value, const ModelPlay &play,
                          SceneDescription part, std::shared_ptr<ModelFiles> models) {
  const JsonValue source = nowhere();
  JsonValue version = number(source, 1);
  version.isInteger = true;
  JsonValue root = object(source, {{"rtsl", std::move(version)},
                                   {key, std::move(value)},
                                   {"frame", number(source, play.frame)}});
  if (play.isDuringFrame)
    set(root, "render", object(source, {{"shutter", numbers(source, {0, 1})}}));
  part.models = std::move(models);
  return readPart(std::make_shared<JsonValue>(std::move(root)), std::move(part));
}

/// A transform as `"matrix"` of a scene file.
JsonValue matrixOf(const runtime::Transform &transform) {
  std::vector<double> all;
  for (std::size_t column = 0; column < 4; ++column) {
    for (const double one : transform.columns[column])
      all.push_back(one);
    all.push_back(column == 3);
  }
  const JsonValue source = nowhere();
  return object(source, {{"matrix", numbers(source, all)}});
}

} // namespace

SceneDescription modelPart(const std::string &path, const ModelPlay &play,
                           const InstanceDescription &above, std::shared_ptr<ModelFiles> models) {
  SceneDescription part;
  part.above = above;
  part.above.scope = part.scopes.front().get();
  return readWith("root", mentionOf(path, play), play, std::move(part), std::move(models));
}

SceneDescription modelCameraPart(const std::string &path, const std::string &name,
                                 const ModelPlay &play, const runtime::Transform &transform,
                                 std::shared_ptr<ModelFiles> models) {
  JsonValue mention = mentionOf(path, play);
  if (!name.empty())
    set(mention, "name", text(nowhere(), name));
  if (!transform.isIdentity())
    set(mention, "transform", matrixOf(transform));
  return readWith("camera", std::move(mention), play, {}, std::move(models));
}

} // namespace rtsl::scene
