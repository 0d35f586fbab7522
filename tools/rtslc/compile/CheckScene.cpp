//===- CheckScene.cpp - rtslc check of a scene ----------------------------===//
#include "CheckCommand.h"
#include "codegen/driver/MachineCode.h"
#include "codegen/driver/SceneProgram.h"
#include "codegen/driver/Stages.h"
#include "tools/rtslc/common/MaterialCheck.h"
#include "tools/rtslc/common/SceneShaders.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

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
  input.machineCode = &driver::machineCode();
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

/// Says which nodes several roots share: at the first, with labels at the roots and other nodes.
void noteSharedNodes(const scene::SceneDescription &description, Messages &messages) {
  constexpr std::size_t shown = 8;
  for (const scene::SharedNodes &shared : description.shared) {
    std::vector<std::string> roots;
    for (const scene::LocatedName &root : shared.roots)
      roots.push_back(fmt::format("`{}`", root.text));
    const scene::LocatedName &first = shared.nodes.front();
    const std::string what = first.text.empty() ? "this node" : fmt::format("`{}`", first.text);
    const std::size_t others = shared.nodes.size() - 1;
    Diagnostic &note =
        messages.diagnostics.report(Code::sharedByRoots, messages.rangeOf(first.place),
                                    others == 0 ? what + " is"
                                                : fmt::format("{} and {} other node{} are", what,
                                                              others, others == 1 ? "" : "s"),
                                    fmt::format("{}", fmt::join(roots, ", ")));
    for (const scene::LocatedName &root : shared.roots)
      note.label(messages.rangeOf(root.place), fmt::format("the root `{}`", root.text));
    for (std::size_t i = 1; i < std::min(shared.nodes.size(), shown); ++i)
      note.label(messages.rangeOf(shared.nodes[i].place), "shared, too");
  }
}

/// The classes of all cameras, with those of the objects that they refer to.
std::vector<scene::LocatedName> classesOfCameras(scene::SceneDescription description) {
  std::vector<scene::LocatedName> all;
  for (const auto &[name, camera] : description.cameras) {
    description.camera = camera;
    const std::vector<scene::LocatedName> mentions = scene::classMentions(description);
    all.insert(all.end(), mentions.begin(), mentions.end());
  }
  return all;
}

} // namespace

void checkScene(const std::string &file, const CheckOptions &options, Messages &messages,
                std::vector<std::string> &filesRead) {
  scene::SceneDescription description = readScene(file, options.overrides, messages, "check");
  const std::unique_ptr<typed::Module> module = loadShaders(
      description, options.common, messages, &filesRead, {}, classesOfCameras(description));
  if (!module)
    return;
  filesRead = withFiles(description, filesRead);
  noteSharedNodes(description, messages);
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
