//===- SceneShaders.cpp - the shaders that a scene file names -------------===//
#include "SceneShaders.h"

#include "Shaders.h"

namespace rtsl::tool {

std::unique_ptr<typed::Module> loadShaders(const scene::SceneDescription &description, const CompileOptions &options,
                                           Messages &messages) {
  Shaders shaders(messages);
  for (const scene::ImportDescription &import : description.imports) {
    const SourceRange range = messages.rangeOf(import.name.place);
    if (import.path.empty())
      messages.diagnostics.report(Code::unknownModule, range, import.name.text);
    else
      shaders.add(import.path, range);
  }
  std::unique_ptr<typed::Module> module = shaders.check(options);
  return messages.diagnostics.hasErrors() ? nullptr : std::move(module);
}

LinkRequest linkRequest(const scene::SceneDescription &description) {
  LinkRequest request;
  request.classes = scene::classesUsed(description);
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

} // namespace rtsl::tool
