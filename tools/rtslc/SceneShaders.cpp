//===- SceneShaders.cpp - the shaders that a scene file names -------------===//
#include "SceneShaders.h"

#include "Shaders.h"
#include "frontend/FileSearch.h"
#include "runtime/Scene.h"

#include <fmt/format.h>

#include <algorithm>

namespace rtsl::tool {

bool isScene(const std::string &file) {
  const std::string extension = ".json";
  return file.size() > extension.size() && file.compare(file.size() - extension.size(), extension.size(), extension) == 0;
}

namespace {

/// Says which classes of the scene no file has, before any code is made.
void refuseUnknownClasses(const scene::SceneDescription &description, const typed::Module &module, Messages &messages) {
  std::vector<std::string> names;
  for (const auto &one : module.classes)
    names.push_back(one->name);
  for (const scene::LocatedName &mention : scene::classMentions(description)) {
    if (module.findClass(mention.text))
      continue;
    const SourceRange range = messages.rangeOf(mention.place);
    Diagnostic &diagnostic = messages.diagnostics.report(Code::sceneUnknownClass, range,
                                                         fmt::format("no class is named `{}`", mention.text));
    if (const auto near = runtime::nearestName(mention.text, names))
      diagnostic.fix(range, *near);
  }
}

} // namespace

std::unique_ptr<typed::Module> loadShaders(const scene::SceneDescription &description, const CommonOptions &options,
                                           Messages &messages, std::vector<std::string> *filesRead) {
  PreprocessorOptions preprocessor = options.preprocessor;
  preprocessor.includeFolders.push_back(folderOf(description.file));
  Shaders shaders(messages, preprocessor);
  for (const scene::ImportDescription &import : description.imports) {
    const SourceRange range = messages.rangeOf(import.name.place);
    if (import.path.empty())
      messages.diagnostics.report(Code::unknownModule, range, import.name.text);
    else
      shaders.add(import.path, range);
  }
  std::unique_ptr<typed::Module> module = shaders.check(options.compile);
  if (!messages.diagnostics.hasErrors())
    refuseUnknownClasses(description, *module, messages);
  if (messages.diagnostics.hasErrors())
    return nullptr;
  if (filesRead) {
    *filesRead = {description.file};
    const std::vector<std::string> &files = shaders.filesRead();
    filesRead->insert(filesRead->end(), files.begin(), files.end());
  }
  return module;
}

std::vector<std::string> withMeshes(const scene::SceneDescription &description, std::vector<std::string> filesRead) {
  for (const scene::GeometryDescription &geometry : description.objects)
    if (!geometry.meshPath.empty() &&
        std::find(filesRead.begin(), filesRead.end(), geometry.meshPath) == filesRead.end())
      filesRead.push_back(geometry.meshPath);
  return filesRead;
}

LinkRequest linkRequest(const scene::SceneDescription &description) {
  LinkRequest request;
  request.classes = scene::classesUsed(description);
  for (const scene::LocatedName &mention : scene::classMentions(description))
    request.places.try_emplace(mention.text,
                               ir::SourcePlace{mention.place.file, mention.place.line, mention.place.column});
  request.engine = description.render.engine;
  if (description.exception)
    request.features |= RTSL_FEATURE_EXCEPTIONS;
  for (const scene::GeometryDescription &geometry : description.objects) {
    const scene::ObjectDescription *material = geometry.material.object.get();
    if (!material)
      if (auto named = description.materials.find(geometry.material.name.text); named != description.materials.end())
        material = &named->second;
    if (material)
      request.surfaces.push_back({geometry.primitive ? geometry.primitive->className.text : std::string(),
                                  material->className.text});
  }
  return request;
}

std::uint32_t features(bool prints, bool exceptions) {
  return (prints ? RTSL_FEATURE_PRINT : 0) | (exceptions ? RTSL_FEATURE_EXCEPTIONS : 0);
}

} // namespace rtsl::tool
