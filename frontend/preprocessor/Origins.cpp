//===- Origins.cpp - from clang's locations to ours -----------------------===//
//
// Clang gives each use of a macro, and each run of tokens of an argument that replaced a parameter,
// a range of locations of its own, with a FileID as for files. Tokens that `##`, `#` and `__LINE__`
// make are in a buffer of clang's ("scratch space"); for these, the use of the macro is shown.
//
//===----------------------------------------------------------------------===//
#include "Origins.h"

#include <clang/Lex/Lexer.h>

namespace rtsl {

std::uint32_t Origins::sizeAt(clang::SourceLocation location) const {
  return clang::Lexer::MeasureTokenLength(locations.getSpellingLoc(location), locations, language);
}

FileId Origins::fileOf(clang::FileID id) {
  auto [entry, isNew] = fileIds.try_emplace(id, 0);
  if (isNew)
    if (const clang::OptionalFileEntryRef file = locations.getFileEntryRefForID(id))
      entry->second = files.fileOf(file->getUniqueID());
  return entry->second;
}

std::uint32_t Origins::includeOf(clang::FileID id) {
  if (const auto found = known.find(id); found != known.end())
    return found->second;
  Expansion expansion;
  const clang::SourceLocation directive = locations.getIncludeLoc(id);
  if (directive.isInvalid() || fileOf(id) == 0)
    return known[id] = 0;
  expansion.kind = Expansion::Include;
  expansion.at = of(directive);
  expansions.push_back(std::move(expansion));
  return known[id] = static_cast<std::uint32_t>(expansions.size() - 1);
}

Origin Origins::of(clang::SourceLocation location, std::uint32_t size) {
  const clang::FileIDAndOffset place = locations.getDecomposedLoc(location);
  if (location.isFileID())
    return {{fileOf(place.first), place.second, place.second + size}, includeOf(place.first)};

  const clang::SrcMgr::ExpansionInfo &info = locations.getSLocEntry(place.first).getExpansion();
  const clang::SourceLocation spelling = locations.getImmediateSpellingLoc(location);
  // An argument belongs to the macro whose body contains the parameter.
  const auto name = [&] {
    return clang::Lexer::getImmediateMacroName(
               info.isMacroArgExpansion() ? info.getExpansionLocStart() : location, locations,
               language)
        .str();
  };
  if (info.isMacroArgExpansion()) {
    const Origin argument = of(spelling, size);
    auto found = known.find(place.first);
    if (found == known.end()) {
      Expansion expansion{Expansion::Argument, name(), of(info.getExpansionLocStart()),
                          argument.expansion};
      expansions.push_back(std::move(expansion));
      found =
          known.try_emplace(place.first, static_cast<std::uint32_t>(expansions.size() - 1)).first;
    }
    return {argument.range, found->second};
  }
  const Origin word = of(locations.getSpellingLoc(location), size);
  if (word.range.file == 0) // made by the preprocessor
    return of(info.getExpansionLocStart(), info.getExpansionLocEnd());
  auto found = known.find(place.first);
  if (found == known.end()) {
    Expansion expansion{Expansion::Macro, name(),
                        of(info.getExpansionLocStart(), info.getExpansionLocEnd()), 0};
    expansions.push_back(std::move(expansion));
    found = known.try_emplace(place.first, static_cast<std::uint32_t>(expansions.size() - 1)).first;
  }
  return {word.range, found->second};
}

Origin Origins::of(clang::SourceLocation first, clang::SourceLocation last) {
  Origin begin = of(first);
  if (first == last)
    return begin;
  const Origin end = of(last);
  if (begin.expansion == end.expansion && begin.range.file == end.range.file &&
      begin.range.begin <= end.range.end)
    begin.range.end = end.range.end;
  return begin;
}

} // namespace rtsl
