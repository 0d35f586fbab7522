//===- Shaders.h - RTSL files, read and checked ---------------------------===//
#pragma once

#include "Messages.h"
#include "codegen/driver/sources/LibraryNames.h"
#include "codegen/driver/sources/SourceLoader.h"
#include "sema/Sema.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace rtsl::tool {

/// The files of one run with all that they import. What is wrong with them goes to the run's
/// messages.
class Shaders {
public:
  Shaders(Messages &messages, const PreprocessorOptions &options)
      : messages(messages), loader(messages.sources, messages.diagnostics, options) {}
  Shaders(Messages &messages, const PreprocessorOptions &options,
          const std::vector<std::string> &files)
      : Shaders(messages, options) {
    for (const std::string &file : files)
      add(file);
  }

  /// Reads and parses a file that was named at `where`, or on the command line.
  void add(const std::string &file, SourceRange where = {}) {
    if (const ast::TranslationUnit *unit = loader.load(file, where))
      parsed.push_back(unit);
  }

  /// Reads and parses what is used of a module that was named at `where`.
  void addModule(const std::string &name, SourceRange where) {
    if (const ast::TranslationUnit *unit = loader.loadModule(name, where))
      parsed.push_back(unit);
  }

  /// Names that count as mentioned by the program.
  void mention(const std::string &name) { loader.mention(name); }

  /// Renames names of the library: SourceLoader.h.
  void renameInLibrary(const std::vector<std::string> &names) { loader.renameInLibrary(names); }

  /// The classes and modules of functions that were imported, `std.cameras.PinholeCamera`.
  const std::vector<std::string> &modules() const { return loader.modules(); }

  /// Reads files and runs the preprocessor alone.
  std::vector<PreprocessedFile> preprocess(const std::vector<std::string> &files) {
    std::vector<PreprocessedFile> preprocessed;
    for (const std::string &file : files)
      if (std::optional<PreprocessedFile> one = loader.preprocessFile(file))
        preprocessed.push_back(std::move(*one));
    return preprocessed;
  }

  const std::vector<const ast::TranslationUnit *> &units() const { return parsed; }

  /// The author's files, with those of them that they import.
  std::vector<const ast::TranslationUnit *> authorsUnits() { return loader.authorsUnits(); }

  /// All files that were read, for -MD.
  const std::vector<std::string> &filesRead() {
    loader.loadImports();
    return loader.files();
  }

  /// Checks everything together, down to what splitting at `trace` would save if requested
  /// (-Wlive-state).
  std::unique_ptr<typed::Module> check(const CompileOptions &options) {
    std::unique_ptr<typed::Module> module = rtsl::check(
        parsed,
        [this](const ast::ImportDecl &import, FileId importer) {
          return loader.resolve(import, importer);
        },
        messages.diagnostics,
        [this](const std::string &name) { return library.moduleThatDefines(name); });
    if (!messages.diagnostics.hasErrors())
      checkLiveState(*module, options, messages.diagnostics);
    return module;
  }

private:
  Messages &messages;
  SourceLoader loader;
  LibraryNames library;
  std::vector<const ast::TranslationUnit *> parsed;
};

} // namespace rtsl::tool
