//===- SourceLoader.h - files and their imports ---------------------------===//
//
// Reads RTSL files, each once however often it is imported, and finds what an import names: a file relative to the one
// that imports it.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "frontend/Ast.h"
#include "frontend/Diagnostics.h"

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace rtsl {

class SourceLoader {
public:
  SourceLoader(SourceManager &sources, Diagnostics &diagnostics)
      : sources(sources), diagnostics(diagnostics) {}

  /// Reads and parses a file ("-" is standard input). Null if it cannot be read; that is reported at `importer`, which
  /// is invalid for a file that was named on the command line.
  const ast::TranslationUnit *load(const std::string &path, SourceRange importer = {});

  /// What `import` means in the file `importer`; null if there is no such file, which is reported.
  const ast::TranslationUnit *resolve(const ast::ImportDecl &import, FileId importer);

  /// The files that were read, in the order of their names.
  std::vector<std::string> files() const;

private:
  SourceManager &sources;
  Diagnostics &diagnostics;
  std::map<std::string, std::unique_ptr<ast::TranslationUnit>> units; // by canonical path
};

} // namespace rtsl
