//===- CompileScene.cpp - rtslc compile of a scene ------------------------===//
#include "CompileCommand.h"
#include "codegen/driver/MachineCode.h"
#include "codegen/driver/SceneProgram.h"
#include "tools/rtslc/common/SceneShaders.h"

#include <memory>

namespace rtsl::tool {

std::optional<std::string> translateScene(const CompileCommandOptions &options, Messages &messages,
                                          std::vector<std::string> &filesRead) {
  scene::SceneDescription description =
      readScene(options.files.front(), options.overrides, messages, "compile");
  const std::unique_ptr<typed::Module> module =
      loadShaders(description, options.common, messages, &filesRead);
  if (!module)
    return std::nullopt;
  filesRead = withFiles(description, filesRead);
  CompileOptions compile = options.common.compile;
  compile.codeCache = keptCode();
  LinkRequest request = linkRequest(description);
  request.features |= features(options.prints, options.exceptions);
  keep(options.common.keep, request, compile);
  std::optional<runtime::Scene> scene;
  CompileInput input;
  input.module = module.get();
  input.scene = &request;
  input.machineCode = &driver::machineCode();
  input.makeObjects = storeScene(
      [&](const auto &constructors) { return scene::buildScene(description, constructors); },
      scene);
  const std::optional<std::string> text =
      emit(*options.stage, input, compile, messages.diagnostics);
  if (scene)
    for (const Warning &warning : scene->warnings())
      messages.report(warning);
  return text;
}

} // namespace rtsl::tool
