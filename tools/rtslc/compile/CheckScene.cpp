//===- CheckScene.cpp - rtslc check of a scene ----------------------------===//
#include "CheckCommand.h"
#include "codegen/driver/SceneProgram.h"
#include "codegen/driver/Stages.h"
#include "tools/rtslc/common/MaterialCheck.h"
#include "tools/rtslc/common/SceneShaders.h"

#include <memory>
#include <optional>

namespace rtsl::tool {

namespace {

/// The shaders of a launch are linked, and its objects made.
void checkLaunch(const scene::SceneDescription &launch, const typed::Module &module,
                 const CheckOptions &options, Messages &messages) {
  std::optional<runtime::Scene> scene;
  const LinkRequest request = linkRequest(launch);
  CompileInput input;
  input.module = &module;
  input.scene = &request;
  input.makeObjects = storeScene(
      [&](const auto &constructors) { return scene::buildScene(launch, constructors); }, scene);
  emit(stage("ir"), input, options.common.compile, messages.diagnostics);
  if (!scene)
    return;
  for (const Warning &warning : scene->warnings())
    messages.report(warning);
  if (!messages.diagnostics.hasErrors() && scattersByMethods(request, scene->program()))
    for (const Warning &warning : tryMaterials(*scene, module, request, options.common.compile))
      messages.report(warning);
}

} // namespace

void checkScene(const std::string &file, const CheckOptions &options, Messages &messages,
                std::vector<std::string> &filesRead) {
  const scene::SceneDescription description = readScene(file, options.overrides, messages, "check");
  const std::unique_ptr<typed::Module> module =
      loadShaders(description, options.common, messages, &filesRead);
  if (!module)
    return;
  filesRead = withFiles(description, filesRead);
  for (std::size_t i = 0; i < scene::launchCount(description); ++i) {
    scene::SceneDescription launch = scene::launchOf(description, i);
    checkLaunch(launch, *module, options, messages);
    for (const auto &[name, camera] : description.cameras) {
      launch.camera = camera; // messages that are reported again are the same
      checkLaunch(launch, *module, options, messages);
    }
  }
}

} // namespace rtsl::tool
