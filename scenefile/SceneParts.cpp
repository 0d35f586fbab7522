#include "scenefile/SceneParts.h"

#include <fmt/format.h>

namespace rtsl::scene {

namespace {

using Kind = JsonValue::Kind;

class Collector {
public:
  explicit Collector(const SceneDescription &scene) : scene(scene) {}

  std::vector<Part> run() {
    // Names first, so that they have indices before they are referred to.
    for (const auto &[name, image] : scene.images)
      named(name, "image ", image);
    for (const auto &[name, helper] : scene.helpers)
      named(name, "helper ", helper);
    for (const auto &[name, texture] : scene.textures)
      named(name, "texture ", texture);
    for (const auto &[name, material] : scene.materials)
      named(name, "material ", material);
    std::size_t next = 0;
    for (const auto *objects : {&scene.images, &scene.helpers, &scene.textures, &scene.materials})
      for (const auto &[name, object] : *objects)
        add(object, parts[next++]);
    root("camera", scene.camera);
    if (scene.render.engine != runtime::Engine::Classic)
      root("rayGeneration", scene.rayGeneration);
    for (std::size_t i = 0; i < scene.objects.size(); ++i)
      geometry(scene.objects[i], fmt::format("objects.{}", i));
    for (std::size_t i = 0; i < scene.lights.size(); ++i)
      add(scene.lights[i],
          begin(Part::Role::Light, fmt::format("lights.{} ({})", i, scene.lights[i].className.text),
                scene.lights[i].place));
    for (std::size_t i = 0; i < scene.selectors.size(); ++i)
      selector(scene.selectors[i], fmt::format("selector {}", i));
    for (const auto &scope : scene.scopes)
      variables(*scope);
    root("background", scene.background);
    root("exception", scene.exception);
    return std::move(parts);
  }

private:
  Part &begin(Part::Role role, std::string name, const Place &place) {
    Part part;
    part.role = role;
    part.name = std::move(name);
    part.place = place;
    parts.push_back(std::move(part));
    return parts.back();
  }

  void named(const std::string &name, const char *kind, const ObjectDescription &object) {
    indices[name] = parts.size();
    begin(Part::Role::Named, kind + name, object.place);
  }

  void root(const char *name, const std::optional<ObjectDescription> &object) {
    if (object)
      add(*object, begin(Part::Role::Root, name, object->place));
  }

  void geometry(const GeometryDescription &geometry, const std::string &name) {
    Part &part = begin(Part::Role::Root, name, geometry.place);
    if (geometry.primitive)
      add(*geometry.primitive, part);
    add(geometry.material, part);
  }

  void selector(const SelectorDescription &selector, const std::string &name) {
    Part &part =
        begin(Part::Role::Root, name,
              selector.object.object ? selector.object.object->place : selector.object.name.place);
    add(selector.object, part);
  }

  /// Objects that variables refer to count as used, whatever takes the variables.
  void variables(const VariableScope &scope) {
    for (const auto &[name, value] : scope.variables)
      add(*value.second, begin(Part::Role::Root, "variable " + name, value.first));
  }

  void add(const ReferenceDescription &reference, Part &part) {
    if (reference.object)
      add(*reference.object, part);
    else
      refer(reference.name.text, part);
  }

  void add(const ObjectDescription &object, Part &part) {
    part.classes.push_back(object.className.text);
    if (object.constructor)
      forEachValue(*object.constructor, [&](const JsonValue &argument) { add(argument, part); });
    for (const auto &member : object.members)
      add(*member.second, part);
  }

  /// Strings are names of objects, except for that of a class.
  void add(const JsonValue &value, Part &part) {
    if (value.kind == Kind::String)
      refer(value.string, part);
    if (isImage(value)) {
      part.classes.push_back(imageClass(value));
      return;
    }
    if (const JsonValue *className = value.find("class");
        className && className->kind == Kind::String)
      part.classes.push_back(className->string);
    forEachValue(value, [&](const JsonValue &inner) {
      if (&inner != value.find("class"))
        add(inner, part);
    });
  }

  void refer(const std::string &name, Part &part) {
    if (const auto found = indices.find(name); found != indices.end())
      part.refersTo.push_back(found->second);
  }

  const SceneDescription &scene;
  std::vector<Part> parts;
  std::map<std::string, std::size_t> indices;
};

} // namespace

std::vector<Part> partsOf(const SceneDescription &description) {
  return Collector(description).run();
}

} // namespace rtsl::scene
