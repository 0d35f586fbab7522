//===- ValueFiles.cpp - images and buffers in files, anywhere in a scene --===//
#include "scenefile/sections/ValueFiles.h"

#include "scenefile/Models.h"
#include "scenefile/json/Reader.h"

#include <set>

namespace rtsl::scene {

static void readFilesIn(const JsonValue &value, SceneDescription &scene, ErrorCollector &errors) {
  if (isImage(value)) {
    errors.attempt([&] {
      ImageDescription image =
          readImage(value, [&](const JsonValue &path) { return resolvePath(path, scene.file); });
      if (!image.part.empty())
        modelsOf(scene).open(image.files.front(), value.find("file")->place());
      scene.imageValues.emplace(&value, std::move(image));
    });
    return;
  }
  if (isBuffer(value)) {
    errors.attempt([&] {
      scene.bufferValues.emplace(&value, readBufferDescription(value, [&](const JsonValue &path) {
        return resolvePath(path, scene.file);
      }));
    });
    return;
  }
  // The files of a node's mesh are no images, and its variables are values by name.
  const bool isNode = !value.find("class");
  const JsonValue *mesh = isNode ? value.find("mesh") : nullptr;
  const JsonValue *variables = isNode ? value.find("variables") : nullptr;
  forEachValue(value, [&](const JsonValue &inner) {
    if (&inner == variables)
      forEachValue(inner, [&](const JsonValue &variable) { readFilesIn(variable, scene, errors); });
    else if (&inner != mesh)
      readFilesIn(inner, scene, errors);
  });
}

void readValueFiles(const JsonValue &root, SceneDescription &scene, ErrorCollector &errors) {
  for (const auto &[key, value] : root.members) {
    const bool isOfNames = key.text == "images" || key.text == "helpers" ||
                           key.text == "textures" || key.text == "materials" ||
                           key.text == "nodes" || key.text == "variables" || key.text == "cameras";
    if (isOfNames)
      forEachValue(value, [&](const JsonValue &object) { readFilesIn(object, scene, errors); });
    else if (key.text != "roots" && key.text != "render")
      readFilesIn(value, scene, errors);
  }
  std::set<std::string> classes;
  for (const auto &image : scene.imageValues)
    classes.insert(imageClass(*image.first));
  for (const std::string &className : classes)
    scene.imports.push_back({{"std.images." + className, root.place()}, ""});
}

} // namespace rtsl::scene
