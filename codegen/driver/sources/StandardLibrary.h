//===- StandardLibrary.h - the files of installed modules -----------------===//
//
// The library is a folder of RTSL files. `std.sampling` is the file std/sampling.rtsl there, or the
// folder std/sampling, whose files are its parts: `std.cameras.PinholeCamera` is one of them.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "frontend/diagnostics/Diagnostics.h"

#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

namespace rtsl {

/// Where the running program finds the library: share/rtslc/library beside the folder of programs,
/// in an installation as in a build tree.
const std::string &libraryFolder();

/// Whether a file of this name, which may be relative or lead through links, is one of the library.
bool isLibraryFile(std::string_view name);

struct ModuleFiles {
  bool exists = false;
  std::string file; // of a module that is one file; empty for a folder
  std::vector<std::string>
      parts; // of a folder: the names of its files, `std.cameras.PinholeCamera`
};

/// The file or files of a module; those of a folder in alphabetical order, with the files of
/// folders within.
ModuleFiles findModule(const std::string &name);

/// The last part of a name: `PinholeCamera` of `std.cameras.PinholeCamera`.
std::string lastPart(const std::string &module);

/// Adds all names and numbers of a text to `words`, those in comments too.
void addWords(std::string_view text, std::unordered_set<std::string> &words);

/// Adds to a message about an unknown module which one may have been meant, and which there are.
/// `where` is the range of the name, for a fix.
void explainModules(Diagnostic &diagnostic, const std::string &name, SourceRange where);

} // namespace rtsl
