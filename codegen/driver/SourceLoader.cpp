//===- SourceLoader.cpp - files and their imports -------------------------===//
#include "codegen/driver/SourceLoader.h"

#include "frontend/preprocessor/FileSearch.h"
#include "frontend/source/Expansion.h"
#include "frontend/syntax/Parser.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace rtsl {

const ast::TranslationUnit *SourceLoader::load(const std::string &path, SourceRange importer) {
  std::error_code error;
  const std::filesystem::path canonical = std::filesystem::weakly_canonical(path, error);
  const std::string key = error || path == "-" ? path : canonical.string();
  if (auto known = units.find(key); known != units.end())
    return known->second.get();

  // Recorded even if loading fails, so that a missing file is reported once.
  std::unique_ptr<ast::TranslationUnit> &unit = units[key];
  if (const std::optional<PreprocessedFile> preprocessed = preprocessFile(path, importer)) {
    if (preprocessed->isUsable) {
      unit = parse(preprocessed->text, diagnostics);
    } else {
      unit = std::make_unique<ast::TranslationUnit>();
      unit->file = preprocessed->text;
    }
  }
  return unit.get();
}

std::optional<PreprocessedFile> SourceLoader::preprocessFile(const std::string &path,
                                                             SourceRange importer) {
  std::string whyNot;
  const std::optional<FileId> file = sources.addFile(path, whyNot);
  if (!file) {
    diagnostics.report(Code::cannotReadSource, importer, path, whyNot);
    return std::nullopt;
  }
  addFile(path);
  PreprocessedFile result = preprocess(*file, sources, options, diagnostics);
  for (const std::string &include : result.includes)
    addFile(include);
  return result;
}

const ast::TranslationUnit *SourceLoader::resolve(const ast::ImportDecl &import, FileId importer) {
  if (!import.isFile) {
    diagnostics.report(Code::unknownModule, import.range, import.path)
        .note(
            "this version has no installed modules; a file is imported as `import \"name.rtsl\";`");
    return nullptr;
  }
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

void SourceLoader::loadImports() {
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
      if (import.isFile)
        pending.push_back(resolve(import, unit->file));
  }
}

void SourceLoader::addFile(const std::string &path) {
  const std::string name = std::filesystem::path(path).lexically_normal().string();
  if (path != "-" && std::find(read.begin(), read.end(), name) == read.end())
    read.push_back(name);
}

} // namespace rtsl
