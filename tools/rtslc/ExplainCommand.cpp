//===- ExplainCommand.cpp - rtslc explain ---------------------------------===//
#include "CommandLine.h"
#include "Messages.h"
#include "Output.h"
#include "SceneShaders.h"
#include "Shaders.h"
#include "scene/SceneFile.h"

#include <algorithm>
#include <map>
#include <memory>

namespace rtsl::tool {

namespace {

struct ExplainOptions {
  CommonOptions common;
  std::vector<std::string> files, overrides;
  std::string output = "-";
  bool states = false;
  ReportFormat format = ReportFormat::Text;
};

std::optional<std::string> explainFiles(const ExplainOptions &options, Messages &messages,
                                        std::vector<std::string> &filesRead) {
  Shaders shaders(messages, options.common.preprocessor, options.files);
  const std::unique_ptr<typed::Module> module = shaders.check(options.common.compile);
  if (messages.diagnostics.hasErrors())
    return std::nullopt;
  filesRead = shaders.filesRead();
  return explainStates(*module, options.common.compile, options.format, messages.diagnostics);
}

std::optional<std::string> explainScene(const ExplainOptions &options, Messages &messages,
                                        std::vector<std::string> &filesRead) {
  const scene::SceneDescription description = scene::readSceneFile(options.files.front(), options.overrides);
  const std::unique_ptr<typed::Module> module = loadShaders(description, options.common, messages, &filesRead);
  if (!module)
    return std::nullopt;
  return explainSceneStates(*module, linkRequest(description), scene::renderOptions(description.render).maxDepth,
                            options.common.compile, options.format, messages.diagnostics);
}

int explain(const ExplainOptions &options) {
  Messages messages(options.common);
  try {
    checkOutput(options.output);
    std::vector<std::string> filesRead;
    const std::optional<std::string> text = isScene(options.files.front()) ? explainScene(options, messages, filesRead)
                                                                           : explainFiles(options, messages, filesRead);
    if (text && !messages.diagnostics.hasErrors()) {
      writeOutput(options.output, *text);
      writeDependencies(options.common.dependencies, options.output, options.files, filesRead);
    }
  } catch (const runtime::Error &error) {
    messages.report(error);
  }
  return messages.status();
}

} // namespace

void addExplainCommand(CLI::App &app, Action &action) {
  auto options = std::make_shared<ExplainOptions>();
  CLI::App *command = app.add_subcommand("explain", "say what the compiler made of a shader, and why");
  command->add_option("FILE", options->files, "RTSL files; - is standard input; or one scene (.json), the program that runs")->required();
  command->add_flag("--states", options->states,
                    "where shaders that trace are cut: their states, and what each trace saves and recomputes")
      ->required();
  command
      ->add_option("--format", options->format, "text; json; dot, for Graphviz; svg, a picture")
      ->transform(CLI::CheckedTransformer(std::map<std::string, ReportFormat>{{"text", ReportFormat::Text},
                                                                              {"json", ReportFormat::Json},
                                                                              {"dot", ReportFormat::Dot},
                                                                              {"svg", ReportFormat::Svg}})
                      .description(""))
      ->type_name("text|json|dot|svg");
  command->add_flag_callback("--json", [options] { options->format = ReportFormat::Json; }, "the same as --format=json");
  command->add_option("-o,--output", options->output, "the file to write; - is standard output")->type_name("OUT");
  command->add_option("--set", options->overrides, "change a value of the scene file, such as render.depth=4")
      ->type_name("PATH=VALUE")
      ->allow_extra_args(false);
  addPreprocessorOptions(*command, options->common.preprocessor);
  addDependencyOptions(*command, options->common.dependencies);
  addCompileOptions(*command, options->common);
  addMessageOptions(*command, options->common);
  command->footer("examples:\n  rtslc explain --states Glass.rtsl\n  rtslc explain --states scene.json\n  rtslc explain --states --format=svg Glass.rtsl -o states.svg");
  command->callback([options, &action] {
    const auto scenes = std::count_if(options->files.begin(), options->files.end(), isScene);
    if (scenes > 0 && options->files.size() > 1)
      throw CLI::ValidationError("FILE", "give RTSL files or one scene");
    if (scenes == 0 && !options->overrides.empty())
      throw CLI::ValidationError("--set", "changes a scene, and no scene is given");
    action = [options] { return explain(*options); };
  });
}

} // namespace rtsl::tool
