//===- StandardLibrary.cpp - the files of installed modules ---------------===//
#include "codegen/driver/sources/StandardLibrary.h"

#include "support/ClosestName.h"
#include "support/ProgramFolder.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace fs = std::filesystem;

namespace rtsl {

const std::string &libraryFolder() {
  static const std::string folder = [] {
    std::error_code error;
    const fs::path library = programFolder() / RTSL_DATA_FROM_PROGRAMS / "rtslc/library";
    const fs::path canonical = fs::canonical(library, error);
    return (error ? library.lexically_normal() : canonical).string();
  }();
  return folder;
}

bool isLibraryFile(std::string_view name) {
  std::error_code error;
  return fs::weakly_canonical(name, error).string().rfind(libraryFolder() + "/", 0) == 0;
}

namespace {

const char *const extension = ".rtsl";

/// The path of a module below the library's folder, without extension.
fs::path pathOf(const std::string &module) {
  std::string path = module;
  std::replace(path.begin(), path.end(), '.', '/');
  return fs::path(libraryFolder()) / path;
}

/// The modules directly in a folder: files and folders, in alphabetical order.
std::vector<std::string> modulesIn(const std::string &folder) {
  std::vector<std::string> modules;
  const std::string prefix = folder.empty() ? "" : folder + ".";
  std::error_code error;
  for (fs::directory_iterator at(pathOf(folder), error), end; !error && at != end;
       at.increment(error))
    if (at->path().extension() == extension || fs::is_directory(at->path(), error))
      modules.push_back(prefix + at->path().stem().string());
  // A folder lists its files in an order that depends on the file system.
  std::sort(modules.begin(), modules.end());
  return modules;
}

/// Modules are in the folder `std`: other folders of the library hold files that are not imported.
bool isModuleName(const std::string &name) {
  return name == "std" || name.rfind("std.", 0) == 0;
}

bool isFolder(const std::string &module) {
  std::error_code error;
  return isModuleName(module) && fs::is_directory(pathOf(module), error);
}

void addParts(const std::string &folder, std::vector<std::string> &parts) {
  for (const std::string &module : modulesIn(folder))
    if (isFolder(module))
      addParts(module, parts);
    else
      parts.push_back(module);
}

} // namespace

ModuleFiles findModule(const std::string &name) {
  ModuleFiles module;
  std::error_code error;
  // `std.` and `../x` name nothing.
  if (name.find('/') != std::string::npos || name.find("..") != std::string::npos ||
      !isModuleName(name) || name.back() == '.')
    return module;
  const std::string file = pathOf(name).string() + extension;
  if (fs::is_regular_file(file, error)) {
    module.file = file;
  } else if (isFolder(name)) {
    addParts(name, module.parts);
  } else {
    return module;
  }
  module.exists = true;
  return module;
}

std::string lastPart(const std::string &module) {
  return module.substr(module.rfind('.') + 1);
}

void addWords(std::string_view text, std::unordered_set<std::string> &words) {
  const auto isOfWord = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  };
  for (auto at = text.begin(); at != text.end();) {
    const auto begin = std::find_if(at, text.end(), isOfWord);
    at = std::find_if_not(begin, text.end(), isOfWord);
    if (begin != at)
      words.emplace(begin, at);
  }
}

void explainModules(Diagnostic &diagnostic, const std::string &name, SourceRange where) {
  if (modulesIn("").empty()) {
    diagnostic.note(fmt::format("there is no standard library in `{}`", libraryFolder()));
    return;
  }
  // List those of the longest prefix of the name that is a module: `std.cameras.Pinhole`.
  std::string folder = name;
  while (!folder.empty() && !isFolder(folder))
    folder = folder.find('.') == std::string::npos ? "" : folder.substr(0, folder.rfind('.'));
  std::vector<std::string> known = modulesIn(folder.empty() ? "std" : folder);
  std::string list;
  for (const std::string &module : known)
    list += fmt::format("{}`{}`", list.empty() ? "" : ", ", lastPart(module));
  std::string closest = closestName(name, known);
  if (closest.empty()) {
    // A class without its module, or with another one.
    std::vector<std::string> all, lasts;
    addParts("std", all);
    for (const std::string &module : all)
      lasts.push_back(lastPart(module));
    const std::string last = lastPart(name);
    auto found = std::find(lasts.begin(), lasts.end(), last);
    if (found == lasts.end())
      found = std::find(lasts.begin(), lasts.end(), closestName(last, lasts));
    if (found != lasts.end())
      closest = all[static_cast<std::size_t>(found - lasts.begin())];
  }
  if (!closest.empty() && where.isValid())
    diagnostic.fix(where, closest);
  diagnostic.note(fmt::format("`{}` has {}", folder.empty() ? "std" : folder, list));
}

} // namespace rtsl
