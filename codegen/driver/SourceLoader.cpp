//===- SourceLoader.cpp - files and their imports -------------------------===//
#include "codegen/driver/SourceLoader.h"

#include "frontend/Parser.h"

#include <filesystem>
#include <system_error>

namespace rtsl {

const ast::TranslationUnit *SourceLoader::load(const std::string &path, SourceRange importer) {
  std::error_code error;
  const std::filesystem::path canonical = std::filesystem::weakly_canonical(path, error);
  const std::string key = error || path == "-" ? path : canonical.string();
  if (auto known = units.find(key); known != units.end())
    return known->second.get();

  // Remembered even when it fails, so that a missing file is reported once.
  std::unique_ptr<ast::TranslationUnit> &unit = units[key];
  std::string whyNot;
  if (const std::optional<FileId> file = sources.addFile(path, whyNot))
    unit = parse(*file, diagnostics);
  else
    diagnostics.report(Code::cannotReadSource, importer, path, whyNot);
  return unit.get();
}

const ast::TranslationUnit *SourceLoader::resolve(const ast::ImportDecl &import, FileId importer) {
  if (!import.isFile) {
    diagnostics.report(Code::unknownModule, import.range, import.path)
        .note("this version has no installed modules; a file is imported as `import \"name.rtsl\";`");
    return nullptr;
  }
  const std::filesystem::path folder =
      std::filesystem::path(std::string(sources.name(importer))).parent_path();
  return load((folder / import.path).string(), import.range);
}

std::vector<std::string> SourceLoader::files() const {
  std::vector<std::string> paths;
  for (const auto &[path, unit] : units)
    if (unit && path != "-")
      paths.push_back(path);
  return paths;
}

} // namespace rtsl
