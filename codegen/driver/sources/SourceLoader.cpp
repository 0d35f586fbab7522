//===- SourceLoader.cpp - files and their imports -------------------------===//
#include "codegen/driver/sources/SourceLoader.h"

#include "codegen/driver/sources/StandardLibrary.h"
#include "frontend/preprocessor/FileSearch.h"
#include "frontend/source/Expansion.h"
#include "frontend/syntax/Parser.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <system_error>

namespace rtsl {

/// Whether a canonical path is that of a file of the library.
static bool isInLibrary(const std::string &path) {
  return path.rfind(libraryFolder() + "/", 0) == 0;
}

/// Whether it is that of an engine. Scenes import these, not authors.
static bool isEngine(const std::string &path) {
  return path.rfind(libraryFolder() + "/std/engines/", 0) == 0;
}

/// The built-in types that are classes of the library, such as `sampler2D`, need no import.
static void importBuiltInClasses(std::string_view text, ast::TranslationUnit &unit) {
  for (const char *name : {"sampler2D", "sampler3D"})
    if (text.find(name) != std::string_view::npos) {
      unit.imports.emplace_back();
      unit.imports.back().path = std::string("std.images.") + name;
    }
}

static const std::string renamePrefix = "std_";

std::string SourceLoader::renamed(const std::string &name) {
  return renamePrefix + name;
}

std::string SourceLoader::original(const std::string &name) {
  return name.rfind(renamePrefix, 0) == 0 ? name.substr(renamePrefix.size()) : name;
}

void SourceLoader::renameInLibrary(const std::vector<std::string> &names) {
  for (const std::string &name : names)
    libraryOptions.macros.push_back({name, renamed(name)});
}

const ast::TranslationUnit *SourceLoader::load(const std::string &path, SourceRange importer) {
  std::error_code error;
  const std::filesystem::path canonical = std::filesystem::weakly_canonical(path, error);
  const std::string key = error || path == "-" ? path : canonical.string();
  if (auto known = units.find(key); known != units.end())
    return known->second.get();

  // Recorded even if loading fails, so that a missing file is reported once.
  std::unique_ptr<ast::TranslationUnit> &unit = units[key];
  // The library does not depend on the macros and folders of those who import it.
  const bool isOurs = isInLibrary(key);
  if (const std::optional<PreprocessedFile> preprocessed =
          preprocessFile(path, importer, isOurs ? libraryOptions : options)) {
    unit = parseFile(*preprocessed);
    const std::string_view text = sources.text(preprocessed->text);
    if (!isOurs)
      addWords(text, words);
    importBuiltInClasses(text, *unit);
    if (isEngine(key))
      renameTaken(path, unit);
    unit->isOfLibrary = isOurs;
  }
  return unit.get();
}

/// The names of a file that all files see.
static std::set<std::string> namesAtFileLevel(const ast::TranslationUnit &unit) {
  std::set<std::string> names;
  const auto add = [&](const auto &declarations) {
    for (const auto &declaration : declarations)
      names.insert(declaration.name.text);
  };
  add(unit.structs);
  add(unit.constants);
  add(unit.functions);
  add(unit.classes);
  return names;
}

void SourceLoader::renameTaken(const std::string &path,
                               std::unique_ptr<ast::TranslationUnit> &engine) {
  std::set<std::string> names = namesAtFileLevel(*engine);
  names.erase(std::filesystem::path(path).stem().string()); // the class that scenes mention
  PreprocessorOptions renaming = libraryOptions;
  for (const auto &[key, unit] : units)
    if (unit && !isInLibrary(key))
      for (const std::string &taken : namesAtFileLevel(*unit))
        if (names.erase(taken))
          renaming.macros.push_back({taken, renamed(taken)});
  if (renaming.macros.size() > libraryOptions.macros.size())
    if (const std::optional<PreprocessedFile> again = preprocessFile(path, {}, renaming))
      engine = parseFile(*again);
}

std::unique_ptr<ast::TranslationUnit>
SourceLoader::parseFile(const PreprocessedFile &preprocessed) {
  if (preprocessed.isUsable)
    return parse(preprocessed.text, diagnostics);
  auto unit = std::make_unique<ast::TranslationUnit>();
  unit->file = preprocessed.text;
  return unit;
}

std::optional<PreprocessedFile> SourceLoader::preprocessFile(const std::string &path,
                                                             SourceRange importer) {
  return preprocessFile(path, importer, options);
}

std::optional<PreprocessedFile>
SourceLoader::preprocessFile(const std::string &path, SourceRange importer,
                             const PreprocessorOptions &fileOptions) {
  std::string whyNot;
  const std::optional<FileId> file = sources.addFile(path, whyNot);
  if (!file) {
    diagnostics.report(Code::cannotReadSource, importer, path, whyNot);
    return std::nullopt;
  }
  addFile(path);
  PreprocessedFile result = preprocess(*file, sources, fileOptions, diagnostics);
  for (const std::string &include : result.includes)
    addFile(include);
  return result;
}

/// The range of a module's name within that of its import; all of that if a comment is in between.
static SourceRange rangeOfName(const std::string &name, SourceRange import,
                               const SourceManager &sources) {
  if (!import.isValid())
    return import;
  const std::string_view text =
      sources.text(import.file).substr(import.begin, import.end - import.begin);
  const std::size_t at = text.find(name);
  if (at == std::string_view::npos)
    return import;
  const auto begin = import.begin + static_cast<decltype(import.begin)>(at);
  return {import.file, begin, begin + static_cast<decltype(import.begin)>(name.size())};
}

const ast::TranslationUnit *SourceLoader::loadModule(const std::string &name,
                                                     SourceRange importer) {
  // Renaming also changes the names in `import std.materials.Lambert;`.
  const std::size_t last = name.rfind('.') + 1;
  ModuleFiles module = findModule(name);
  if (!module.exists && !libraryOptions.macros.empty())
    module = findModule(name.substr(0, last) + original(name.substr(last)));
  if (!module.exists) {
    const SourceRange range = rangeOfName(name, importer, sources);
    explainModules(diagnostics.report(Code::unknownModule, range, name), name, range);
    return nullptr;
  }
  if (!module.file.empty()) {
    if (isEngine(module.file))
      loadImports(false); // its names depend on those of the author's files
    offered.push_back(name);
    return load(module.file, importer);
  }
  // The files of the folder are known now, but the names that the program mentions only when all of
  // its files have been read.
  loadImports(false);
  std::unique_ptr<ast::TranslationUnit> &unit = units["module " + name];
  if (!unit) {
    offered.insert(offered.end(), module.parts.begin(), module.parts.end());
    unit = std::make_unique<ast::TranslationUnit>();
    for (const std::string &part : module.parts)
      if (words.count(lastPart(part))) {
        unit->imports.emplace_back();
        unit->imports.back().path = part;
        unit->imports.back().range = importer;
      }
  }
  return unit.get();
}

const ast::TranslationUnit *SourceLoader::resolve(const ast::ImportDecl &import, FileId importer) {
  if (!import.isFile)
    return loadModule(import.path, import.range);
  // An import in an included file is relative to that file.
  const FileId file = import.range.isValid() ? sources.written(import.range).range.file : importer;
  std::vector<std::string> folders{folderOf(sources.name(file))};
  folders.insert(folders.end(), options.includeFolders.begin(), options.includeFolders.end());
  if (const std::optional<std::string> found = findFile(import.path, folders))
    return load(*found, import.range);
  explainSearch(diagnostics.report(Code::includeNotFound, import.range, import.path), import.path,
                folders, {});
  return nullptr;
}

void SourceLoader::loadImports(bool withModules) {
  std::vector<const ast::TranslationUnit *> pending, done;
  for (const auto &[path, unit] : units)
    pending.push_back(unit.get());
  while (!pending.empty()) {
    const ast::TranslationUnit *unit = pending.back();
    pending.pop_back();
    if (!unit || std::find(done.begin(), done.end(), unit) != done.end())
      continue;
    done.push_back(unit);
    for (const ast::ImportDecl &import : unit->imports)
      if (import.isFile || withModules)
        pending.push_back(resolve(import, unit->file));
  }
}

std::vector<const ast::TranslationUnit *> SourceLoader::authorsUnits() {
  loadImports(false);
  std::vector<const ast::TranslationUnit *> authors;
  for (const auto &[path, unit] : units)
    if (unit && !unit->isOfLibrary)
      authors.push_back(unit.get());
  return authors;
}

void SourceLoader::addFile(const std::string &path) {
  const std::string name = std::filesystem::path(path).lexically_normal().string();
  if (path != "-" && std::find(read.begin(), read.end(), name) == read.end())
    read.push_back(name);
}

} // namespace rtsl
