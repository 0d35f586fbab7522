#include "scenefile/LibraryNames.h"

namespace rtsl::scene {

namespace {

class Renaming {
public:
  explicit Renaming(const std::map<std::string, std::string> &names) : names(names) {}

  void rename(SceneDescription &scene) const {
    rename(*scene.root);
    for (auto *object : {&scene.camera, &scene.rayGeneration, &scene.background, &scene.exception})
      if (*object)
        rename(**object);
    for (PassDescription &pass : scene.passes)
      rename(pass.rayGeneration);
    for (auto *named : {&scene.images, &scene.helpers, &scene.textures, &scene.materials})
      for (auto &object : *named)
        rename(object.second);
    for (GeometryDescription &geometry : scene.objects) {
      if (geometry.primitive)
        rename(*geometry.primitive);
      rename(geometry.material);
    }
    for (SelectorDescription &selector : scene.selectors)
      rename(selector.object);
    for (ObjectDescription &light : scene.lights)
      rename(light);
  }

private:
  void rename(std::string &name) const {
    if (const auto found = names.find(name); found != names.end())
      name = found->second;
  }

  /// Of objects that are written in place of a reference.
  void rename(JsonValue &value) const {
    if (value.isOfLibrary)
      rename(value.string);
    for (JsonValue &element : value.elements)
      rename(element);
    for (auto &member : value.members)
      rename(member.second);
  }

  void rename(ObjectDescription &object) const {
    if (object.className.isOfLibrary)
      rename(object.className.text);
  }

  void rename(ReferenceDescription &reference) const {
    if (reference.object)
      rename(*reference.object);
  }

  const std::map<std::string, std::string> &names;
};

} // namespace

void renameLibraryClasses(SceneDescription &scene,
                          const std::map<std::string, std::string> &names) {
  Renaming(names).rename(scene);
}

} // namespace rtsl::scene
