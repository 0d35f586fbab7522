//===- FileWatch.h - notices when files change ----------------------------===//
#pragma once

#include <chrono>
#include <ctime>
#include <filesystem>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace rtsl::tool {

/// Notices that files were written, by inotify (Linux). It watches their folders, because many
/// editors do not write a file but rename another one to its name.
class FileWatch {
public:
  /// Throws Error with FileUnreadable if inotify is not available.
  FileWatch();
  ~FileWatch();
  FileWatch(const FileWatch &) = delete;
  FileWatch &operator=(const FileWatch &) = delete;

  /// The files to notice from now on, under their names and as targets of links. With `noticesNew`
  /// also any other file that appears beside them, unless it is hidden or `ignored`: one that was
  /// missing. A file that was written after `since` counts as changed. Throws as the constructor.
  void watch(const std::vector<std::string> &files, std::timespec since, bool noticesNew,
             const std::string &ignored);

  /// Waits until a file changes and the changes pause, or until the time is over. Whether one has.
  bool wait(std::chrono::milliseconds time);

  /// The time in the clock of files.
  static std::timespec now();

private:
  using Entry = std::pair<int, std::string>; // the watch of a folder, and a name in it

  Entry entryOf(const std::filesystem::path &file);
  bool readEvents(std::chrono::milliseconds time);
  bool isNoticed(int folder, const std::string &name) const;

  int queue = -1;
  std::set<Entry> files;
  Entry ignoredFile;
  bool noticesNew = false;
  bool hasChanged = false; // before it was watched
};

} // namespace rtsl::tool
