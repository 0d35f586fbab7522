//===- ExplainScene.cpp - rtslc explain of a scene ------------------------===//
#include "ExplainCommand.h"
#include "ExplainGpu.h"
#include "Explanation.h"
#include "MeasureItems.h"
#include "codegen/driver/SceneProgram.h"
#include "scenefile/SceneFile.h"
#include "tools/common/Progress.h"
#include "tools/rtslc/common/SceneShaders.h"

#include <algorithm>
#include <memory>

namespace rtsl::tool {

namespace {

/// A scene, its shaders, and how to make its objects.
struct LoadedScene {
  LoadedScene(const ExplainOptions &options, Messages &messages,
              std::vector<std::string> &filesRead)
      : description(readScene(options.files.front(), options.overrides, messages, "explain")),
        module(loadShaders(description, options.common, messages, &filesRead)),
        request(linkRequest(description)), compile(options.common.compile),
        makeObjects(storeScene(builder(), scene)) {
    compile.codeCache = keptCode();
    keep(options.common.keep, request, compile);
    filesRead = withFiles(description, filesRead);
  }
  LoadedScene(const LoadedScene &) = delete;

  BuildScene builder() const {
    return [this](const auto &program) { return scene::buildScene(description, program); };
  }

  scene::SceneDescription description;
  std::unique_ptr<typed::Module> module; // null if there were errors
  LinkRequest request;
  CompileOptions compile;
  std::optional<runtime::Scene> scene; // once makeObjects was called
  MakeObjects makeObjects;
};

std::optional<std::string> explainStates(const ExplainOptions &options, LoadedScene &loaded,
                                         Messages &messages) {
  return explainSceneStates(*loaded.module, loaded.request,
                            scene::renderOptions(loaded.description.render).maxDepth,
                            loaded.compile, options.format, messages.diagnostics);
}

std::optional<std::string> explainOnGpu(const ExplainOptions &options, LoadedScene &loaded,
                                        Messages &messages) {
  const BuildScene build = loaded.builder();
  return explainGpu({options.files.front(), *loaded.module, loaded.request, loaded.compile, build,
                     scene::renderOptions(loaded.description.render).maxDepth,
                     options.gpuOptions.maxRegisters, options.format == ReportFormat::Json},
                    messages.diagnostics);
}

/// Renders the scene with each item kept that something was left out for, and with everything kept.
std::optional<std::vector<ItemMeasurement>> measureScene(const ExplainOptions &options,
                                                         const SceneExplanation &explanation,
                                                         LoadedScene &loaded, Messages &messages) {
  const BuildScene build = loaded.builder();
  MeasureRequest what{*loaded.module,
                      loaded.request,
                      loaded.compile,
                      build,
                      scene::renderOptions(loaded.description.render),
                      {},
                      {},
                      options.pairs,
                      {}};
  options.size.value_or(PictureSize{320, 180}).apply(what.render);
  what.render.samplesPerPixel = options.samples;
  what.render.threads = 1;
  for (Item item : allItems) {
    const auto isLeftOut = [&](const Finding &finding) {
      return finding.item == item && !finding.isNeeded;
    };
    const auto &ofMeshes = loaded.scene->meshAttributes();
    const bool inMeshes = std::any_of(ofMeshes.begin(), ofMeshes.end(), [&](const auto &attribute) {
      return itemOf(attribute) == item;
    });
    if (loaded.request.keep.has(item) ||
        (!inMeshes &&
         std::none_of(explanation.findings.begin(), explanation.findings.end(), isLeftOut)))
      continue;
    what.kept.push_back(ItemSet::only(item));
    what.names.push_back(nameOf(item));
  }
  what.kept.push_back(ItemSet::all());
  what.names.push_back("all");
  Progress progress("measuring");
  what.progress = [&](double share) { progress.update(share); };
  return measureItems(what, messages.diagnostics);
}

std::optional<std::string> explainNeeds(const ExplainOptions &options, LoadedScene &loaded,
                                        Messages &messages) {
  const std::optional<SceneExplanation> explanation =
      explainScene(*loaded.module, loaded.request, loaded.compile, messages.diagnostics,
                   loaded.makeObjects, !options.noSavings);
  if (!explanation)
    return std::nullopt;
  for (const Warning &warning : loaded.scene->warnings())
    messages.report(warning);
  loaded.scene->useProgram(explanation->program);
  Explanation whole(loaded.description.file, *explanation, loaded.scene->meshAttributes());
  if (options.measure) {
    const auto measurements = measureScene(options, *explanation, loaded, messages);
    if (!measurements)
      return std::nullopt;
    whole.add(*measurements);
  }
  return options.format == ReportFormat::Json ? whole.json() : whole.text();
}

} // namespace

std::optional<std::string> explainScene(const ExplainOptions &options, Messages &messages,
                                        std::vector<std::string> &filesRead) {
  LoadedScene loaded(options, messages, filesRead);
  if (!loaded.module)
    return std::nullopt;
  if (options.gpu)
    return explainOnGpu(options, loaded, messages);
  return options.states ? explainStates(options, loaded, messages)
                        : explainNeeds(options, loaded, messages);
}

} // namespace rtsl::tool
