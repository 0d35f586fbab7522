//===- SourceLoader.h - files and their imports ---------------------------===//
//
// Reads RTSL files, each once however often it is imported, and resolves imports
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

  /// Reads a file and runs only the preprocessor; nothing if it cannot be read.
  std::optional<PreprocessedFile> preprocessFile(const std::string &path,
                                                 SourceRange importer = {});

  /// The file that an `import` in the file `importer` names; null if there is none, which is
  /// reported.
  const ast::TranslationUnit *resolve(const ast::ImportDecl &import, FileId importer);

  /// Loads the imports of the loaded files, transitively. (Checking also loads them on demand.)
  void loadImports();

  /// All files that were read, including imported and included ones, each once, in the order of
  /// reading.
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
