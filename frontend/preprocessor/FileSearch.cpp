//===- FileSearch.cpp - the file that a name denotes ----------------------===//
#include "frontend/preprocessor/FileSearch.h"

#include "support/ClosestName.h"

#include <algorithm>
#include <filesystem>

namespace fs = std::filesystem;

namespace rtsl {

std::string folderOf(std::string_view file) {
  const std::string folder = fs::path(file).parent_path().string();
  return folder.empty() ? "." : folder;
}

std::optional<std::string> findFile(const std::string &name,
                                    const std::vector<std::string> &folders) {
  std::error_code error;
  const auto isFile = [&](const fs::path &path) {
    return fs::exists(path, error) && !fs::is_directory(path, error);
  };
  if (fs::path(name).is_absolute())
    return isFile(name) ? std::optional(name) : std::nullopt;
  for (const std::string &folder : folders) {
    const fs::path path = folder == "." ? fs::path(name) : fs::path(folder) / name;
    if (isFile(path))
      return path.string();
  }
  return std::nullopt;
}

void explainSearch(Diagnostic &diagnostic, const std::string &name,
                   const std::vector<std::string> &folders, SourceRange place) {
  const fs::path path(name);
  std::vector<std::string> searched, siblings;
  for (const std::string &folder : path.is_absolute() ? std::vector<std::string>{"/"} : folders) {
    if (std::find(searched.begin(), searched.end(), folder) == searched.end())
      searched.push_back(folder);
    std::error_code error;
    const fs::path parent = fs::path(folder) / path.parent_path();
    for (fs::directory_iterator at(parent, error), end;
         !error && at != end && siblings.size() < 10000; at.increment(error))
      siblings.push_back(at->path().filename().string());
  }
  // A folder lists its files in an order that depends on the file system.
  std::sort(siblings.begin(), siblings.end());
  if (!path.is_absolute()) {
    std::string list;
    for (const std::string &folder : searched)
      list += fmt::format("{}`{}`", list.empty() ? "" : ", ", folder);
    diagnostic.note(searched.empty()
                        ? "`<...>` is searched only in the folders of `-I`, and none was given"
                        : "searched in " + list);
  }
  const std::string closest = closestName(path.filename().string(), siblings);
  if (closest.empty())
    return;
  const std::string meant = (path.parent_path() / closest).string();
  if (place.isValid())
    diagnostic.fix(place, meant);
  else
    diagnostic.note(fmt::format("did you mean `{}`?", meant));
}

} // namespace rtsl
