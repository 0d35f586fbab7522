//===- CheckCommand.cpp - rtslc check -------------------------------------===//
#include "CommandLine.h"
#include "Messages.h"
#include "codegen/driver/SourceLoader.h"
#include "runtime/AtomicFile.h"
#include "sema/Sema.h"

#include <fmt/format.h>

#include <memory>

namespace rtsl::tool {

namespace {

struct CheckOptions {
  CommonOptions common;
  std::vector<std::string> files;
  bool fix = false;
};

/// Writes back the texts that sure fixes change. A file that came from standard input goes to standard output.
void writeFixes(Messages &messages) {
  for (const FixedText &fixed : applyFixes(messages.diagnostics)) {
    const std::string path(messages.sources.name(fixed.file));
    if (path == "<stdin>") {
      std::fwrite(fixed.text.data(), 1, fixed.text.size(), stdout);
      continue;
    }
    runtime::writeFileAtomically(path, fixed.text);
    fmt::print(stderr, "{}: {} fixed\n", path, fixed.applied == 1 ? "1 mistake" : fmt::format("{} mistakes", fixed.applied));
  }
}

int check(const CheckOptions &options) {
  Messages messages(options.common);
  SourceLoader loader(messages.sources, messages.diagnostics);
  std::vector<const ast::TranslationUnit *> units;
  for (const std::string &file : options.files)
    if (const ast::TranslationUnit *unit = loader.load(file))
      units.push_back(unit);
  rtsl::check(
      units, [&](const ast::ImportDecl &import, FileId importer) { return loader.resolve(import, importer); },
      messages.diagnostics);
  messages.print();
  if (options.fix)
    writeFixes(messages);
  return messages.status();
}

} // namespace

void addCheckCommand(CLI::App &app, Action &action) {
  auto options = std::make_shared<CheckOptions>();
  CLI::App *command = app.add_subcommand("check", "look for mistakes in RTSL files");
  command->add_option("FILE", options->files, "RTSL files; - is standard input")->required();
  command->add_flag("--fix", options->fix, "apply the fixes that are sure, and write the files back");
  addMessageOptions(*command, options->common);
  command->footer("example:\n  rtslc check --diagnostics=json Glass.rtsl Sphere.rtsl");
  command->callback([options, &action] { action = [options] { return check(*options); }; });
}

} // namespace rtsl::tool
