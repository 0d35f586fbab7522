//===- CheckCommand.cpp - rtslc check -------------------------------------===//
#include "CheckCommand.h"

#include "support/AtomicFile.h"
#include "tools/rtslc/common/Messages.h"
#include "tools/rtslc/common/SceneArguments.h"
#include "tools/rtslc/common/Shaders.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

namespace rtsl::tool {

namespace {

std::string count(std::size_t number, const char *noun) {
  return fmt::format("{} {}{}", number, noun, number == 1 ? "" : "s");
}

/// Writes the corrected texts back, all of them or, if one cannot be written, none. What came from
/// standard input goes to standard output. Gives whether anything was corrected.
bool writeFixes(const Messages &messages) {
  const std::vector<FileId> files = filesToFix(messages.diagnostics);
  const auto path = [&](FileId file) { return std::string(messages.sources.name(file)); };
  for (const FileId file : files)
    if (path(file) != "<stdin>")
      checkFileWritable(path(file));
  for (const FileId file : files) {
    const FixedText fixed = applyFixes(messages.diagnostics, file);
    writeFileAtomically(path(file) == "<stdin>" ? "-" : path(file), fixed.text);
    fmt::print(stderr, "{}: {} fixed", path(file), count(fixed.applied, "mistake"));
    fmt::print(stderr,
               fixed.skipped ? ", {} skipped because they overlap with these: run again\n" : "\n",
               fixed.skipped);
  }
  return !files.empty();
}

/// All that is wrong with scenes and, checked together, with RTSL files. Gives the files that were
/// read.
std::vector<std::string> checkFiles(const CheckOptions &options, SceneChecker checkScene,
                                    Messages &messages) {
  std::vector<std::string> sources, filesRead;
  for (const std::string &file : options.files) {
    if (!isScene(file)) {
      sources.push_back(file);
      continue;
    }
    std::vector<std::string> ofScene;
    try {
      checkScene(file, options, messages, ofScene);
    } catch (const Error &error) {
      messages.report(error);
    }
    filesRead.insert(filesRead.end(), ofScene.begin(), ofScene.end());
  }
  if (sources.empty())
    return filesRead;
  Shaders shaders(messages, options.common.preprocessor, sources);
  shaders.check(options.common.compile);
  filesRead.insert(filesRead.end(), shaders.filesRead().begin(), shaders.filesRead().end());
  return filesRead;
}

/// The status of files that have been corrected. If they have errors, these are shown, after a line
/// with their number; as JSON there is one document, which has been printed.
int statusOfCorrected(const CheckOptions &options, SceneChecker checkScene,
                      std::vector<std::string> &filesRead) {
  Messages left(options.common);
  left.diagnostics.errorLimit = 0;
  filesRead = checkFiles(options, checkScene, left);
  const bool isFine = left.status() == Fine, isJson = options.common.jsonDiagnostics;
  if (!isFine)
    fmt::print(stderr, "{} left{}\n", count(left.diagnostics.errorCount(), "mistake"),
               isJson ? "" : ":\n");
  if (isFine || isJson)
    left.silence();
  return left.status();
}

int check(const CheckOptions &options, SceneChecker checkScene) {
  Messages messages(options.common);
  if (options.fix)
    messages.diagnostics.errorLimit = 0; // what is not recorded cannot be fixed
  std::vector<std::string> filesRead = checkFiles(options, checkScene, messages);
  messages.print();
  int status = messages.status();
  if (options.fix || options.common.dependencies.isAsked)
    try {
      const bool isStandardInput =
          std::find(options.files.begin(), options.files.end(), "-") != options.files.end();
      if (options.fix && writeFixes(messages) && status != Fine && !isStandardInput)
        status = statusOfCorrected(options, checkScene, filesRead);
      checkOutputs("", options.common.dependencies, options.files, filesRead);
      if (status == Fine)
        writeDependencies(options.common.dependencies, "", options.files, filesRead);
    } catch (const Error &error) {
      fmt::print(stderr, "rtslc: {}\n", error.what());
      return Diagnosed;
    }
  return status;
}

} // namespace

void addCheckCommand(CLI::App &app, Action &action, SceneChecker checkScene) {
  auto options = std::make_shared<CheckOptions>();
  CLI::App *command = app.add_subcommand("check", "check RTSL files and scenes for mistakes");
  command
      ->add_option("FILE", options->files,
                   "RTSL files, which are checked together; scenes (.json) and models, each "
                   "with its shaders; - is standard input")
      ->required();
  command->add_flag("--fix", options->fix, "apply unambiguous fixes to the files");
  addSetOption(*command, options->overrides);
  addPreprocessorOptions(*command, options->common.preprocessor);
  addDependencyOptions(*command, options->common.dependencies);
  addMessageOptions(*command, options->common);
  command->footer("examples:\n  rtslc check --diagnostics=json Glass.rtsl Sphere.rtsl\n  rtslc "
                  "check scene.json");
  command->callback([options, checkScene, &action] {
    if (!options->overrides.empty() &&
        std::none_of(options->files.begin(), options->files.end(), isScene))
      throw CLI::ValidationError("--set", "changes a scene, and no scene is given");
    action = [options, checkScene] { return check(*options, checkScene); };
  });
}

} // namespace rtsl::tool
