//===- CommandLine.h - what the commands of rtslc share -------------------===//
#pragma once

#include "PreprocessorCommandLine.h"
#include "codegen/driver/Compiler.h"
#include "frontend/diagnostics/Diagnostics.h"

#include <CLI/CLI.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace rtsl::driver {
struct MachineCode;
} // namespace rtsl::driver

namespace rtsl::tool {

/// How a run ends, for scripts.
enum ExitStatus : int {
  Fine = 0,
  Diagnosed =
      1, // errors in what the user gave: source, scene, mesh, image; or no memory or disk for it
  Usage = 2,         // arguments that make no sense
  InternalError = 3, // a fault of rtslc itself
};

/// Options that every command understands.
struct CommonOptions {
  bool jsonDiagnostics = false;
  std::string ansi = "auto"; // colour on the terminal: auto, always, never
  std::size_t errorLimit = 20;
  WarningOptions warnings;
  CompileOptions compile;
  PreprocessorOptions preprocessor;
  DependencyOptions dependencies;
  ItemSet keep; // of programs of scenes
};

/// Adds --diagnostics, --ansi, --error-limit and -W.
void addMessageOptions(CLI::App &command, CommonOptions &options);
/// Adds --keep.
void addKeepOption(CLI::App &command, CommonOptions &options);
/// Adds --color, --fp, --unchecked, --trace, --gpu-arch and -O.
void addCompileOptions(CLI::App &command, CommonOptions &options);
/// Adds all of these, and those of PreprocessorCommandLine.h: for a command that compiles one
/// program of files or of a scene.
void addProgramOptions(CLI::App &command, CommonOptions &options);

/// RTSL_FEATURE_* of a program that is to print and to raise exceptions.
std::uint32_t features(bool prints, bool exceptions);

/// A command's name and its description in `rtslc --help`.
struct Summary {
  const char *command;
  const char *text;
};
constexpr Summary renderSummary = {"render",
                                   "render a scene, or a standard scene that shows a class"};
constexpr Summary runSummary = {"run", "run a scene's launches and write their output buffers"};
constexpr Summary traceSummary = {"trace", "trace the rays of a file against a mesh"};
constexpr Summary reportSummary = {"report",
                                   "measure error against run time, in each configuration"};
constexpr Summary packSummary = {"pack",
                                 "write a scene with its compiled code to one file, for rtsl-run"};
constexpr Summary compareSummary = {
    "compare", "measure the difference of two pictures (exit status 1: too large)"};

/// What a command does once the arguments are read; gives the exit status.
using Action = std::function<int()>;

/// What commands do with a scene: checkScene, translateScene, explainScene. Null in rtslc, which
/// hands scenes over, and stages of machine code, too.
struct CheckOptions;
struct CompileCommandOptions;
struct ExplainOptions;
class Messages;
using SceneChecker = void (*)(const std::string &file, const CheckOptions &, Messages &,
                              std::vector<std::string> &filesRead);
using SceneTranslator = std::optional<std::string> (*)(const CompileCommandOptions &, Messages &,
                                                       std::vector<std::string> &filesRead);
using SceneExplainer = std::optional<std::string> (*)(const ExplainOptions &, Messages &,
                                                      std::vector<std::string> &filesRead);

void addNewCommand(CLI::App &app, Action &action);
void addCheckCommand(CLI::App &app, Action &action, SceneChecker checkScene);
void addCompileCommand(CLI::App &app, Action &action, SceneTranslator translateScene,
                       const driver::MachineCode *machineCode);
void addExplainCommand(CLI::App &app, Action &action, SceneExplainer explainScene);
void addRenderCommand(CLI::App &app, Action &action);
void addRunCommand(CLI::App &app, Action &action);
void addTraceCommand(CLI::App &app, Action &action);
void addReportCommand(CLI::App &app, Action &action);
void addPackCommand(CLI::App &app, Action &action);
void addCompareCommand(CLI::App &app, Action &action);

/// Does `first`, reads the arguments and executes them. Gives the exit status, whatever is
/// thrown.
int run(
    CLI::App &app, Action &action, int argc, char **argv,
    const std::function<void()> &first = [] {});

} // namespace rtsl::tool
