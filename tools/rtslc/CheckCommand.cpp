//===- CheckCommand.cpp - rtslc check -------------------------------------===//
#include "CommandLine.h"
#include "Messages.h"
#include "Shaders.h"
#include "runtime/AtomicFile.h"

#include <fmt/format.h>

#include <memory>

namespace rtsl::tool {

namespace {

struct CheckOptions {
  CommonOptions common;
  std::vector<std::string> files;
  bool fix = false;
};

std::string count(std::size_t number, const char *noun) {
  return fmt::format("{} {}{}", number, noun, number == 1 ? "" : "s");
}

/// Writes the mended texts back, all of them or, if one cannot be written, none. What came from standard input goes to
/// standard output.
void writeFixes(const Messages &messages) {
  const std::vector<FileId> files = filesToFix(messages.diagnostics);
  const auto path = [&](FileId file) { return std::string(messages.sources.name(file)); };
  for (const FileId file : files)
    if (path(file) != "<stdin>")
      runtime::checkFileWritable(path(file));
  for (const FileId file : files) {
    const FixedText fixed = applyFixes(messages.diagnostics, file);
    if (path(file) == "<stdin>")
      fmt::print("{}", fixed.text);
    else
      runtime::writeFileAtomically(path(file), fixed.text);
    fmt::print(stderr, "{}: {} fixed", path(file), count(fixed.applied, "mistake"));
    fmt::print(stderr, fixed.skipped ? ", {} left that overlap with these: run again\n" : "\n", fixed.skipped);
  }
}

int check(const CheckOptions &options) {
  Messages messages(options.common);
  if (options.fix)
    messages.diagnostics.errorLimit = 0; // what is not recorded cannot be fixed
  Shaders shaders(messages, options.common.preprocessor, options.files);
  shaders.check(options.common.compile);
  messages.print();
  if (options.fix || options.common.dependencies.isAsked)
    try {
      if (options.fix)
        writeFixes(messages);
      if (!messages.diagnostics.hasErrors())
        writeDependencies(options.common.dependencies, "", options.files, shaders.filesRead());
    } catch (const runtime::Error &error) {
      fmt::print(stderr, "rtslc: {}\n", error.what());
      return Diagnosed;
    }
  return messages.status();
}

} // namespace

void addCheckCommand(CLI::App &app, Action &action) {
  auto options = std::make_shared<CheckOptions>();
  CLI::App *command = app.add_subcommand("check", "look for mistakes in RTSL files");
  command->add_option("FILE", options->files, "RTSL files; - is standard input")->required();
  command->add_flag("--fix", options->fix, "apply the fixes that are sure, and write the files back");
  addPreprocessorOptions(*command, options->common.preprocessor);
  addDependencyOptions(*command, options->common.dependencies);
  addMessageOptions(*command, options->common);
  command->footer("example:\n  rtslc check --diagnostics=json Glass.rtsl Sphere.rtsl");
  command->callback([options, &action] { action = [options] { return check(*options); }; });
}

} // namespace rtsl::tool
