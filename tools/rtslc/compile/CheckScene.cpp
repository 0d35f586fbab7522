//===- CheckScene.cpp - rtslc check of a scene ----------------------------===//
#include "CheckCommand.h"
#include "codegen/driver/MachineCode.h"
#include "codegen/driver/SceneProgram.h"
#include "codegen/driver/Stages.h"
#include "scenefile/files/KeptFiles.h"
#include "support/ErrorCollector.h"
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

constexpr std::size_t mostKeyFrames = 32; // besides the frame of the scene

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
  if (!scene || options.errorsOnly)
    return;
  for (const Warning &warning : scene->warnings())
    messages.report(warning);
  const bool isWhole = launch.refused.names.empty() && launch.refused.classes.empty();
  if (isWhole && !messages.diagnostics.hasErrors() && hasSurfaceMethods(request, scene->program()))
    for (const Warning &warning :
         tryMaterials(*scene, module, messages.sources, request, options.common.compile))
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

/// Checks what the scene says of its objects, in all launches and for all cameras.
void checkLaunches(const scene::SceneDescription &description, const typed::Module &module,
                   const CheckOptions &options, Messages &messages, ErrorCollector &errors) {
  if (description.refused.isAny)
    return;
  for (std::size_t i = 0; i < scene::launchCount(description); ++i) {
    scene::SceneDescription launch = scene::launchOf(description, i);
    errors.attempt([&] { checkLaunch(launch, module, options, messages); });
    for (const auto &[name, camera] : description.cameras) {
      launch.camera = camera; // messages that are reported again are the same
      errors.attempt([&] { checkLaunch(launch, module, options, messages); });
    }
  }
}

/// The imports without those in which, or in whose names, there are errors.
std::vector<scene::ImportDescription> soundImports(const scene::SceneDescription &description,
                                                   Messages &messages) {
  std::vector<scene::ImportDescription> sound;
  for (const scene::ImportDescription &import : description.imports) {
    const SourceRange name = messages.rangeOf(import.name.place);
    const auto isOfImport = [&](const Diagnostic &diagnostic) {
      const SourceRange &range = diagnostic.range;
      const bool isInName = range.file == name.file && range.begin == name.begin;
      return diagnostic.severity == Severity::Error && range.isValid() &&
             (isInName || messages.sources.name(range.file) == import.path);
    };
    const std::vector<Diagnostic> &all = messages.diagnostics.all();
    if (std::none_of(all.begin(), all.end(), isOfImport))
      sound.push_back(import);
  }
  return sound;
}

/// Checks what the scene says of objects of those classes whose files have no errors. Which other
/// classes there are is unknown, and warnings are for when there are no errors.
void checkSoundPart(scene::SceneDescription description, const CheckOptions &options,
                    Messages &messages, ErrorCollector &errors) {
  description.imports = soundImports(description, messages);
  Messages known(options.common);
  known.silence();
  ErrorCollector unknown;
  const std::unique_ptr<typed::Module> module =
      loadShaders(description, options.common, known, nullptr, {}, {}, &unknown);
  if (module)
    checkLaunches(description, *module, options, known, errors);
}

/// Checks one frame of the scene, and gives what the scene is then. `errors` gets those in the
/// scene, because reported earlier they would end the check of the shaders.
scene::SceneDescription checkFrame(const std::string &file, const CheckOptions &options,
                                   const std::shared_ptr<scene::KeptFiles> &kept,
                                   Messages &messages, std::vector<std::string> &filesRead,
                                   ErrorCollector &errors) {
  scene::SceneDescription description =
      readScene(file, options.overrides, messages, "check", kept, &errors);
  const std::unique_ptr<typed::Module> module =
      loadShaders(description, options.common, messages, &filesRead, {},
                  classesOfCameras(description), &errors);
  if (module) {
    filesRead = withFiles(description, filesRead);
    noteSharedNodes(description, messages);
    checkLaunches(description, *module, options, messages, errors);
  } else {
    checkSoundPart(description, options, messages, errors);
  }
  return description;
}

void report(ErrorCollector errors, Messages &messages) {
  try {
    errors.throwIfAny();
  } catch (const Error &error) {
    messages.report(error); // once, if it was reported for another frame
  }
}

/// Checks the scene at a key frame. What there is to say of shaders is known from the scene's own
/// frame, unless another class is used in this one.
void checkKeyFrame(const std::string &file, const CheckOptions &options,
                   const std::shared_ptr<scene::KeptFiles> &kept, Messages &messages,
                   std::vector<std::string> &filesRead) {
  Messages known(options.common);
  known.silence();
  ErrorCollector errors;
  checkFrame(file, options, kept, known, filesRead, errors);
  const bool isOfShaders = known.diagnostics.hasErrors() && !messages.diagnostics.hasErrors();
  report(std::move(errors), messages);
  ErrorCollector again;
  if (isOfShaders)
    checkFrame(file, options, kept, messages, filesRead, again);
}

} // namespace

void checkScene(const std::string &file, const CheckOptions &given, Messages &messages,
                std::vector<std::string> &filesRead) {
  CheckOptions options = given;
  options.common.compile.codeCache = keptCode();
  const auto kept = std::make_shared<scene::KeptFiles>();
  ErrorCollector errors;
  const scene::SceneDescription description =
      checkFrame(file, options, kept, messages, filesRead, errors);
  report(std::move(errors), messages);
  std::size_t checked = 0;
  for (const double frame : description.keyFrames) {
    if (frame == description.frame)
      continue;
    if (++checked > mostKeyFrames)
      break;
    CheckOptions ofFrame = options;
    ofFrame.errorsOnly = true; // a light may be dark at times
    ofFrame.overrides.push_back(fmt::format("frame={}", frame));
    std::vector<std::string> more;
    checkKeyFrame(file, ofFrame, kept, messages, more);
    filesRead.insert(filesRead.end(), more.begin(), more.end());
  }
}

} // namespace rtsl::tool
