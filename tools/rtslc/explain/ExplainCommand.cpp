//===- ExplainCommand.cpp - rtslc explain ---------------------------------===//
#include "ExplainCommand.h"

#include "support/AtomicFile.h"
#include "tools/common/GpuOptions.h"
#include "tools/common/OptionValues.h"
#include "tools/common/PictureOptions.h"
#include "tools/rtslc/common/Messages.h"
#include "tools/rtslc/common/SceneArguments.h"
#include "tools/rtslc/common/Shaders.h"

#include <algorithm>
#include <memory>

namespace rtsl::tool {

namespace {

std::optional<std::string> explainFiles(const ExplainOptions &options, Messages &messages,
                                        std::vector<std::string> &filesRead) {
  Shaders shaders(messages, options.common.preprocessor, options.files);
  const std::unique_ptr<typed::Module> module = shaders.check(options.common.compile);
  if (messages.diagnostics.hasErrors())
    return std::nullopt;
  filesRead = shaders.filesRead();
  return explainStates(*module, options.common.compile, options.format, messages.diagnostics);
}

int explain(const ExplainOptions &options, SceneExplainer explainScene) {
  Messages messages(options.common);
  try {
    checkOutputs(options.output, options.common.dependencies, options.files);
    std::vector<std::string> filesRead;
    const std::optional<std::string> text = isScene(options.files.front())
                                                ? explainScene(options, messages, filesRead)
                                                : explainFiles(options, messages, filesRead);
    if (text && !messages.diagnostics.hasErrors()) {
      checkOutputs(options.output, options.common.dependencies, options.files, filesRead);
      writeFileAtomically(options.output, *text);
      writeDependencies(options.common.dependencies, options.output, options.files, filesRead);
    }
  } catch (const Error &error) {
    messages.report(error);
  }
  return messages.status();
}

} // namespace

void addExplainCommand(CLI::App &app, Action &action, SceneExplainer explainScene) {
  auto options = std::make_shared<ExplainOptions>();
  CLI::App *command =
      app.add_subcommand("explain", "explain what the compiler kept, left out and saved, and why");
  command
      ->add_option("FILE", options->files,
                   "a scene (.json): what its program contains and leaves out; with --states also "
                   "RTSL files; - is standard input")
      ->required();
  command->add_flag("--states", options->states,
                    "show where shaders that trace are cut into states, and what each trace saves "
                    "and rematerialises");
  command->add_flag("--gpu", options->gpu,
                    "show what the program costs a GPU: registers, spills, local memory and "
                    "occupancy, of all of it and of each state, and the bytes of waiting rays");
  addMaxRegistersOption(*command, options->gpuOptions);
  command->add_flag("--measure", options->measure,
                    "render alternately with each item left out and kept: time, instructions, and "
                    "whether the picture is the same");
  command->add_flag(
      "--no-savings", options->noSavings,
      "only list what is needed and what is left out: the program is compiled once, and "
      "not once more for each item");
  addWhole(*command, "--pairs", options->pairs, 10, 10000,
           "with --measure: pairs of renderings per item; default 11");
  addSizeOption(*command, options->size);
  addWhole(*command, "--spp", options->samples, 1, runtime::mostSamplesPerPixel,
           "with --measure: samples per pixel; default 1");
  const Choices<ReportFormat> formats = {{"text", ReportFormat::Text},
                                         {"json", ReportFormat::Json},
                                         {"dot", ReportFormat::Dot},
                                         {"svg", ReportFormat::Svg}};
  addChoice(
      *command, "--format", options->format, formats,
      "text or json; with --states also dot, for Graphviz, or svg, a picture laid out by Graphviz");
  command->add_flag_callback(
      "--json", [options] { options->format = ReportFormat::Json; }, "the same as --format=json");
  command->add_option("-o,--output", options->output, "the file to write; - is standard output")
      ->type_name("OUT");
  addSetOption(*command, options->overrides);
  addProgramOptions(*command, options->common);
  command->footer("examples:\n  rtslc explain scene.json\n  rtslc explain scene.json --measure\n  "
                  "rtslc explain scene.json --gpu --gpu-arch=sm_90\n  "
                  "rtslc explain --states Glass.rtsl\n  rtslc explain --states scene.json\n  rtslc "
                  "explain --states --format=svg Glass.rtsl -o states.svg");
  command->callback([options, explainScene, command, &action] {
    const auto scenes = std::count_if(options->files.begin(), options->files.end(), isScene);
    if (scenes > 0 && options->files.size() > 1)
      throw CLI::ValidationError("FILE", "give RTSL files or one scene");
    if (scenes == 0 && !options->overrides.empty())
      throw CLI::ValidationError("--set", "changes a scene, and no scene is given");
    if (options->gpu && scenes == 0)
      throw CLI::ValidationError("--gpu", "explains the program of a scene; give a scene");
    if (scenes == 0 && !options->states)
      throw CLI::ValidationError(
          "FILE", "what a program needs depends on the scene; give a scene, or --states");
    if (scenes == 0 && !options->common.keep.isEmpty())
      throw CLI::ValidationError("--keep", "is for scenes: a file alone keeps everything");
    if (options->gpu && (options->states || options->measure || options->noSavings))
      throw CLI::ValidationError("--gpu",
                                 "cannot be combined with --states, --measure or --no-savings");
    if (options->gpu && options->common.compile.floatingPoint == FloatingPoint::Double)
      throw CLI::ValidationError("--fp", "shaders on a GPU compute in single precision");
    if (!options->gpu && command->get_option("--max-registers")->count() > 0)
      throw CLI::ValidationError("--max-registers", "is for --gpu");
    if (options->states && options->measure)
      throw CLI::ValidationError("--measure", "cannot be combined with --states");
    if (options->states && options->noSavings)
      throw CLI::ValidationError("--no-savings", "cannot be combined with --states");
    if (!options->states &&
        (options->format == ReportFormat::Dot || options->format == ReportFormat::Svg))
      throw CLI::ValidationError("--format", "only --states has pictures");
    action = [options, explainScene] { return explain(*options, explainScene); };
  });
}

} // namespace rtsl::tool
