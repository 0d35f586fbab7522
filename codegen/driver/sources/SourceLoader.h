//===- SourceLoader.h - files and their imports ---------------------------===//
//
// Reads RTSL files, each once however often it is imported, and resolves imports: files
// (frontend/preprocessor/FileSearch.h) and modules (StandardLibrary.h). If a module is a folder,
// only the files whose names the program mentions are read, so that importing it costs nothing.
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
#include <unordered_set>
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

  /// Reads and parses what is used of a module of the standard library. Null if there is no such
  /// module; that is reported at `importer`.
  const ast::TranslationUnit *loadModule(const std::string &name, SourceRange importer);

  /// Names, such as those of a scene's classes, that count as mentioned by the program.
  void mention(const std::string &name) { words.insert(original(name)); }

  /// Renames these names at file level in the library, so that files that import nothing of it may
  /// use them for something of their own. To be called before any file is loaded.
  void renameInLibrary(const std::vector<std::string> &names);
  /// What renameInLibrary() makes of a name.
  static std::string renamed(const std::string &name);

  /// The file that an `import` in the file `importer` names; null if there is none, which is
  /// reported.
  const ast::TranslationUnit *resolve(const ast::ImportDecl &import, FileId importer);

  /// Loads the imports of the loaded files, transitively. (Checking also loads them on demand.)
  void loadImports() { loadImports(true); }

  /// The author's files, with those of them that they import.
  std::vector<const ast::TranslationUnit *> authorsUnits();

  /// All files that were read, including imported and included ones, each once, in the order of
  /// reading.
  const std::vector<std::string> &files() const { return read; }

  /// The files of the modules that were imported, `std.cameras.PinholeCamera`, read or not.
  const std::vector<std::string> &modules() const { return offered; }

private:
  static std::string original(const std::string &name);
  void addFile(const std::string &path);
  void loadImports(bool withModules);
  /// Parses the file of an engine again if the author's files have names that it has, too: in it
  /// they become others.
  void renameTaken(const std::string &path, std::unique_ptr<ast::TranslationUnit> &engine);
  /// The unit of a file, which is empty if it cannot be parsed.
  std::unique_ptr<ast::TranslationUnit> parseFile(const PreprocessedFile &preprocessed);
  std::optional<PreprocessedFile> preprocessFile(const std::string &path, SourceRange importer,
                                                 const PreprocessorOptions &options);

  SourceManager &sources;
  Diagnostics &diagnostics;
  PreprocessorOptions options;
  PreprocessorOptions libraryOptions; // macros that rename: none of the author's
  std::vector<std::string> read;
  std::vector<std::string> offered;
  std::unordered_set<std::string> words; // of all files but those of the library
  std::map<std::string, std::unique_ptr<ast::TranslationUnit>> units; // by canonical path
};

} // namespace rtsl
