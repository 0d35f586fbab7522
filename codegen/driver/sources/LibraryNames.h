//===- LibraryNames.h - which module of the library defines a name --------===//
#pragma once

#include "codegen/driver/sources/SourceLoader.h"

#include <string>
#include <unordered_set>
#include <vector>

namespace rtsl {

/// For messages about unknown names. The library's files are read at the first call; only those
/// that contain the name are parsed, each once.
class LibraryNames {
public:
  /// The module that defines a class, struct, constant or function of this name at file level:
  /// "std.noise". Empty if there is none.
  std::string moduleThatDefines(const std::string &name);

private:
  struct Module {
    std::string name, file;
    std::unordered_set<std::string> words;
  };

  std::vector<Module> modules;
  SourceManager sources;
  Diagnostics diagnostics{sources};
  SourceLoader loader{sources, diagnostics};
};

} // namespace rtsl
