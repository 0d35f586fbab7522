//===- CompileCommand.cpp - rtslc compile ---------------------------------===//
#include "CompileCommand.h"

#include "codegen/cpp/EmitCpp.h"
#include "codegen/driver/Stages.h"
#include "support/AtomicFile.h"
#include "tools/common/OptionValues.h"
#include "tools/rtslc/common/Messages.h"
#include "tools/rtslc/common/SceneArguments.h"
#include "tools/rtslc/common/Shaders.h"

#include <algorithm>
#include <memory>

namespace rtsl::tool {

namespace {

/// The text of the requested stage of RTSL files; nothing if there were errors.
std::optional<std::string> translate(const CompileCommandOptions &options,
                                     const driver::MachineCode *machineCode, Messages &messages,
                                     std::vector<std::string> &filesRead) {
  CompileInput input;
  input.machineCode = machineCode;
  Shaders shaders(messages, options.common.preprocessor);
  std::unique_ptr<typed::Module> module;
  if (options.stage->needs == Stage::Needs::Text) {
    input.texts = shaders.preprocess(options.files);
  } else {
    for (const std::string &file : options.files)
      shaders.add(file);
    input.units = shaders.units();
  }
  if (options.stage->needs == Stage::Needs::Module) {
    module = shaders.check(options.common.compile);
    if (messages.diagnostics.hasErrors())
      return std::nullopt;
    input.module = module.get();
  }
  const std::string &named = options.output == "-" ? options.files.front() : options.output;
  input.cpp = {cpp::identifierOf(named), options.lineDirectives, options.trace,
               features(options.prints, options.exceptions)};
  const std::optional<std::string> text =
      emit(*options.stage, input, options.common.compile, messages.diagnostics);
  if (!messages.diagnostics.hasErrors())
    filesRead = shaders.filesRead();
  return text;
}

/// A scene names its shaders itself, and has stages from the IR on.
void checkInputs(const CompileCommandOptions &options) {
  if (!options.stage)
    throw CLI::RequiredError("--emit");
  const auto scenes = std::count_if(options.files.begin(), options.files.end(), isScene);
  if (scenes > 0 && options.files.size() > 1)
    throw CLI::ValidationError("FILE", "give RTSL files or one scene");
  if (scenes > 0 && options.stage->whyNoScene)
    throw CLI::ValidationError("--emit", options.stage->whyNoScene);
  if (scenes == 0 && !options.stage->keepsEvents &&
      features(options.prints, options.exceptions) != 0)
    throw CLI::ValidationError(options.prints ? "--print" : "--exceptions",
                               "is for C++ and for scenes");
  if (!options.stage->hasDouble && options.common.compile.floatingPoint == FloatingPoint::Double)
    throw CLI::ValidationError("--fp",
                               "double is for machine code of this processor; give strict or fast");
  if (scenes == 0 && !options.overrides.empty())
    throw CLI::ValidationError("--set", "changes a scene, and no scene is given");
  if (scenes == 0 && !options.common.keep.isEmpty())
    throw CLI::ValidationError("--keep", "is for scenes: a file alone keeps everything");
}

int compile(const CompileCommandOptions &options, SceneTranslator translateScene,
            const driver::MachineCode *machineCode) {
  Messages messages(options.common);
  try {
    checkOutputs(options.output, options.common.dependencies, options.files);
    std::vector<std::string> filesRead;
    const std::optional<std::string> text =
        isScene(options.files.front()) ? translateScene(options, messages, filesRead)
                                       : translate(options, machineCode, messages, filesRead);
    if (text && !messages.diagnostics.hasErrors()) {
      checkOutputs(options.output, options.common.dependencies, options.files, filesRead);
      // First what names the output: where that cannot be written, the old output stays.
      writeDependencies(options.common.dependencies, options.output, options.files, filesRead);
      writeFileAtomically(options.output, *text);
    }
  } catch (const Error &error) {
    messages.report(error);
  }
  return messages.status();
}

} // namespace

void addCompileCommand(CLI::App &app, Action &action, SceneTranslator translateScene,
                       const driver::MachineCode *machineCode) {
  auto options = std::make_shared<CompileCommandOptions>();
  CLI::App *command = app.add_subcommand("compile", "compile RTSL files, and print any stage");
  command
      ->add_option("FILE", options->files, "RTSL files; - is standard input; or one scene (.json)")
      ->required();
  Choices<const Stage *> choices;
  for (const Stage &stage : stages())
    choices.emplace_back(stage.name, &stage);
  addChoice(*command, "--emit", options->stage, choices, "the stage to write");
  command->add_flag_callback(
      "-E", [options] { options->stage = &stage("preprocessed"); },
      "the same as --emit=preprocessed");
  command->add_option("-o,--output", options->output, "the file to write; - is standard output")
      ->type_name("OUT");
  addSetOption(*command, options->overrides);
  command->add_flag(
      "--line-directives", options->lineDirectives,
      "with --emit=cpp: add #line, so that messages and debuggers refer to the RTSL files");
  command->add_flag("--print", options->prints,
                    "for C++ or a scene: keep calls of `print`, which are otherwise left out");
  command->add_flag("--exceptions", options->exceptions,
                    "for C++ or a scene: end samples that send an invalid ray, exceed the depth "
                    "limit, or use an index out of range");
  addProgramOptions(*command, options->common);
  command->footer("examples:\n"
                  "  rtslc compile Glass.rtsl --emit=ssa -o Glass.mlir\n"
                  "  rtslc compile Glass.rtsl --emit=cpp -o glass.cpp\n"
                  "  rtslc compile scene.json --emit=ptx --gpu-arch=sm_90 -o scene.ptx");
  command->callback([options, command, translateScene, machineCode, &action] {
    if (command->count("--trace") > 0)
      options->trace = options->common.compile.trace;
    checkInputs(*options);
    action = [=] { return compile(*options, translateScene, machineCode); };
  });
}

} // namespace rtsl::tool
