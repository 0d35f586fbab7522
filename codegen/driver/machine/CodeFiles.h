//===- CodeFiles.h - code of earlier runs ---------------------------------===//
//
// Half of the time until a small picture is there goes into generating code, and a scene that is
// rendered again mostly gets the same. So it is kept in a folder of the user's, in a file for each
// module, named by all that decides what code the module gets. No failure here is an
// error: code that cannot be read is made again, and code that cannot be kept is not.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <memory>
#include <optional>
#include <string>

namespace rtsl {

/// May be used by several threads and processes at once.
class CodeFiles {
public:
  /// The files in the folder that the environment variable RTSL_CACHE names, or else in `rtslc` in
  /// the folder of the user's caches (XDG Base Directory Specification). Null if RTSL_CACHE is
  /// `off` or empty, if there is no such folder and it cannot be made, and if others may write to
  /// it: its code is executed.
  static std::unique_ptr<CodeFiles> open();

  /// Removes what was not used for longest if there is too much; looks every 20 minutes.
  ~CodeFiles();

  /// The code of the module that `identity` names; nothing if there is none, or it is damaged.
  std::optional<std::string> read(const std::string &identity) const;

  void write(const std::string &identity, const std::string &code) const;

private:
  explicit CodeFiles(std::string folder);

  std::string pathOf(const std::string &identity) const;

  std::string folder, builtFrom;
};

} // namespace rtsl
