//===- Session.h - one run of clang's preprocessor ------------------------===//
#pragma once

#include "Origins.h"
#include "Preprocessor.h"
#include "TextBuilder.h"

#include <clang/Lex/HeaderSearch.h>
#include <clang/Lex/Preprocessor.h>

namespace rtsl {

/// What the parts of the preprocessor share: clang's objects, and the reporting of our messages.
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
  /// False after a mistake from which later stages cannot recover.
  bool isUsable = true;
  /// True once a limit was exceeded. Nothing more is read or reported.
  bool isStopped = false;

  /// Reports at the range where the tokens at `origin` were written, with the chain of expansions.
  template <typename... Args>
  Diagnostic &report(Code code, const Origin &origin, const Args &...args) {
    const WrittenRange place = written(origins.expansions, origin);
    Diagnostic &diagnostic = diagnostics.report(code, place.range, args...);
    explainOrigin(diagnostic, place, sources);
    return diagnostic;
  }

  void undefineMacros(const std::vector<std::string_view> &kept = {});

  /// Ends the run: no more macros are expanded, and included files are treated as empty. Clang
  /// cannot be interrupted, but its remaining work is bounded by the text that it already holds.
  void stop();

  /// The folders that are searched for `#include "..."`, or `<...>`, in the file `from`.
  std::vector<std::string> searchedFolders(FileId from, bool isAngled) const;
};

} // namespace rtsl
