//===- Session.cpp - one run of clang's preprocessor ----------------------===//
#include "Session.h"

#include "frontend/preprocessor/FileSearch.h"

#include <algorithm>

namespace rtsl {

void Session::undefineMacros(const std::vector<std::string_view> &kept) {
  std::vector<clang::IdentifierInfo *> macros;
  for (const auto &[name, state] : preprocessor.macros())
    if (name->hasMacroDefinition() &&
        std::find(kept.begin(), kept.end(), std::string_view(name->getName())) == kept.end())
      macros.push_back(preprocessor.getIdentifierInfo(name->getName()));
  const clang::SourceLocation start = locations.getLocForStartOfFile(locations.getMainFileID());
  for (clang::IdentifierInfo *name : macros)
    preprocessor.appendMacroDirective(name, new (preprocessor.getPreprocessorAllocator())
                                                clang::UndefMacroDirective(start));
}

void Session::stop() {
  isStopped = true;
  isUsable = false;
  undefineMacros();
}

std::vector<std::string> Session::searchedFolders(FileId from, bool isAngled) const {
  std::vector<std::string> folders = options.includeFolders;
  if (!isAngled)
    folders.insert(folders.begin(), folderOf(sources.name(from)));
  return folders;
}

} // namespace rtsl
