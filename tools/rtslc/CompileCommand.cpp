//===- CompileCommand.cpp - rtslc compile ---------------------------------===//
#include "CommandLine.h"
#include "Messages.h"
#include "Output.h"
#include "Shaders.h"
#include "codegen/driver/Compiler.h"
#include "frontend/Parser.h"

#include <map>
#include <memory>

namespace rtsl::tool {

namespace {

const std::map<std::string, Stage> stages = {{"ast", Stage::Ast},
                                             {"typed-ast", Stage::TypedAst},
                                             {"ir", Stage::Ir},
                                             {"ssa", Stage::Ssa},
                                             {"split", Stage::Split},
                                             {"llvm", Stage::Llvm}};

struct CompileCommandOptions {
  CommonOptions common;
  std::vector<std::string> files;
  Stage stage = Stage::Ir;
  std::string output = "-";
};

/// The text of the asked stage; nothing if there were errors.
std::optional<std::string> translate(const CompileCommandOptions &options, Messages &messages) {
  Shaders shaders(messages, options.files);
  if (options.stage == Stage::Ast) {
    std::string text;
    for (const ast::TranslationUnit *unit : shaders.units())
      text += dump(*unit);
    return messages.diagnostics.hasErrors() ? std::nullopt : std::optional(text);
  }

  const std::unique_ptr<typed::Module> module = shaders.check();
  if (messages.diagnostics.hasErrors())
    return std::nullopt;
  if (options.stage == Stage::TypedAst)
    return typed::dump(*module);
  return emit(*module, options.stage, options.common.compile, messages.diagnostics);
}

int compile(const CompileCommandOptions &options) {
  Messages messages(options.common);
  try {
    checkOutput(options.output);
    const std::optional<std::string> text = translate(options, messages);
    if (text && !messages.diagnostics.hasErrors())
      writeOutput(options.output, *text);
  } catch (const runtime::Error &error) {
    messages.report(error);
  }
  return messages.status();
}

} // namespace

void addCompileCommand(CLI::App &app, Action &action) {
  auto options = std::make_shared<CompileCommandOptions>();
  CLI::App *command = app.add_subcommand("compile", "translate RTSL files, and show any stage on the way");
  command->add_option("FILE", options->files, "RTSL files; - is standard input")->required();
  command->add_option("--emit", options->stage, "what to write")
      ->transform(CLI::CheckedTransformer(stages).description(""))
      ->type_name("ast|typed-ast|ir|ssa|split|llvm")
      ->required();
  command->add_option("-o,--output", options->output, "the file to write; - is standard output")->type_name("OUT");
  addCompileOptions(*command, options->common);
  addMessageOptions(*command, options->common);
  command->footer("example:\n  rtslc compile Glass.rtsl --emit=ssa -o Glass.mlir");
  command->callback([options, &action] { action = [options] { return compile(*options); }; });
}

} // namespace rtsl::tool
