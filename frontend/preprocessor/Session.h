//===- Session.h - one run of clang's preprocessor ------------------------===//
#pragma once

#include "Origins.h"
#include "Preprocessor.h"
#include "TextBuilder.h"

#include <clang/Lex/HeaderSearch.h>
#include <clang/Lex/Preprocessor.h>

namespace rtsl {

/// What the parts of the preprocessor share: clang's objects, and the way to our messages.
struct Session {
  clang::SourceManager &locations;
  clang::Preprocessor &preprocessor;
  Origins &origins;
  SourceManager &sources;
  const PreprocessorOptions &options;
  Diagnostics &diagnostics;
  TextBuilder &builder;

  /// Files that were read, each once.
  std::vector<std::string> includes{};
  /// False after a mistake behind which the rest cannot be understood.
  bool isUsable = true;
  /// True once a limit was passed. Nothing is read and nothing is said any more.
  bool isStopped = false;

  /// Reports at the place where the words at `origin` were written, with the way from there.
  template <typename... Args>
  Diagnostic &report(Code code, const Origin &origin, const Args &...args) {
    const WrittenRange place = written(origins.expansions, origin);
    Diagnostic &diagnostic = diagnostics.report(code, place.range, args...);
    explainOrigin(diagnostic, place, sources);
    return diagnostic;
  }

  void undefineMacros(const std::vector<std::string_view> &kept = {});

  /// Ends the run: no macro is expanded any more, and what is included is taken as empty. Clang
  /// cannot be interrupted where it is, but what it still does is bounded by what it holds.
  void stop();

  /// Where `#include "..."`, or `<...>`, in the file at hand looks for a file.
  std::vector<std::string> searchedFolders(FileId from, bool isAngled) const;
};

} // namespace rtsl
