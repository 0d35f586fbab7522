//===- Folder.h - a folder for files, for tests ---------------------------===//
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace rtsl::scene::test {

/// A folder for files, which is removed with it.
class Folder {
public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "scene-XXXXXX").string();
    path = mkdtemp(name.data());
  }
  Folder(const Folder &) = delete;
  ~Folder() { std::filesystem::remove_all(path); }

  void write(const std::string &name, const std::string &bytes) const {
    std::ofstream(path + "/" + name, std::ios::binary) << bytes;
  }
  /// A text without the folder's name.
  std::string without(std::string text) const {
    for (std::size_t at = text.find(path + "/"); at != std::string::npos;
         at = text.find(path + "/"))
      text.erase(at, path.size() + 1);
    return text;
  }

  std::string path;
};

} // namespace rtsl::scene::test
