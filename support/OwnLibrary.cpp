//===- OwnLibrary.cpp - parts that are loaded when they are needed --------===//
#include "support/OwnLibrary.h"

#include "support/ProgramFolder.h"

#include <dlfcn.h>

#include <filesystem>

namespace rtsl {

namespace fs = std::filesystem;

void *findInOwnLibrary(const char *file, const char *symbol, std::string &why) {
  Dl_info own{};
  dladdr(reinterpret_cast<void *>(&findInOwnLibrary), &own);
  const fs::path beside = fs::path(own.dli_fname ? own.dli_fname : "").parent_path() / file;
  std::error_code error;
  const fs::path path =
      fs::exists(beside, error) ? beside : programFolder() / RTSL_LIBRARIES_FROM_PROGRAMS / file;
  void *library = dlopen(path.c_str(), RTLD_LAZY | RTLD_LOCAL);
  void *found = library ? dlsym(library, symbol) : nullptr;
  if (!found)
    why = dlerror();
  return found;
}

} // namespace rtsl
