//===- SourceLoader.h - files and their imports ---------------------------===//
//
// Reads RTSL files, each once however often it is imported, and finds what an import names
// (frontend/preprocessor/FileSearch.h).
//
//===----------------------------------------------------------------------===//
#pragma once

#include "frontend/diagnostics/Diagnostics.h"
#include "frontend/preprocessor/Preprocessor.h"
#include "frontend/syntax/Ast.h"

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace rtsl {

class SourceLoader {
public:
  SourceLoader(SourceManager &sources, Diagnostics &diagnostics, PreprocessorOptions options = {})
      : sources(sources), diagnostics(diagnostics), options(std::move(options)) {}

  /// Reads and parses a file ("-" is standard input). Null if it cannot be read; that is reported
  /// at `importer`, which is invalid for a file that was named on the command line.
  const ast::TranslationUnit *load(const std::string &path, SourceRange importer = {});

  /// Reads a file and runs the preprocessor alone; nothing if it cannot be read.
  std::optional<PreprocessedFile> preprocessFile(const std::string &path,
                                                 SourceRange importer = {});

  /// What `import` means in the file `importer`; null if there is no such file, which is reported.
  const ast::TranslationUnit *resolve(const ast::ImportDecl &import, FileId importer);

  /// Loads what the loaded files import, and so on. (Checking does so as well, where it comes to
  /// that.)
  void loadImports();

  /// All files that were read, imported and included ones too, each once, in the order in which
  /// they were met.
  const std::vector<std::string> &files() const { return read; }

private:
  void addFile(const std::string &path);

  SourceManager &sources;
  Diagnostics &diagnostics;
  PreprocessorOptions options;
  std::vector<std::string> read;
  std::map<std::string, std::unique_ptr<ast::TranslationUnit>> units; // by canonical path
};

} // namespace rtsl
