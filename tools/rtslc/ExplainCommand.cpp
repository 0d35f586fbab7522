//===- ExplainCommand.cpp - rtslc explain ---------------------------------===//
#include "CommandLine.h"
#include "Messages.h"
#include "Output.h"
#include "Shaders.h"

#include <map>
#include <memory>

namespace rtsl::tool {

namespace {

struct ExplainOptions {
  CommonOptions common;
  std::vector<std::string> files;
  std::string output = "-";
  bool states = false;
  ReportFormat format = ReportFormat::Text;
};

int explain(const ExplainOptions &options) {
  Messages messages(options.common);
  try {
    checkOutput(options.output);
    Shaders shaders(messages, options.common.preprocessor, options.files);
    const std::unique_ptr<typed::Module> module = shaders.check(options.common.compile);
    if (!messages.diagnostics.hasErrors())
      if (const auto text = explainStates(*module, options.common.compile, options.format, messages.diagnostics))
        writeOutput(options.output, *text);
    if (!messages.diagnostics.hasErrors())
      writeDependencies(options.common.dependencies, options.output, options.files, shaders.filesRead());
  } catch (const runtime::Error &error) {
    messages.report(error);
  }
  return messages.status();
}

} // namespace

void addExplainCommand(CLI::App &app, Action &action) {
  auto options = std::make_shared<ExplainOptions>();
  CLI::App *command = app.add_subcommand("explain", "say what the compiler made of a shader, and why");
  command->add_option("FILE", options->files, "RTSL files; - is standard input")->required();
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
  addPreprocessorOptions(*command, options->common.preprocessor);
  addDependencyOptions(*command, options->common.dependencies);
  addCompileOptions(*command, options->common);
  addMessageOptions(*command, options->common);
  command->footer("example:\n  rtslc explain --states Glass.rtsl\n  rtslc explain --states --format=svg Glass.rtsl -o states.svg");
  command->callback([options, &action] { action = [options] { return explain(*options); }; });
}

} // namespace rtsl::tool
