//===- TextBuilder.h - tokens to an expanded text -------------------------===//
#pragma once

#include "Origins.h"

#include <clang/Lex/Preprocessor.h>

#include <llvm/ADT/DenseMap.h>

#include <vector>

namespace rtsl {

/// Assembles the output of the preprocessor so that it reads as the author wrote it: text from a
/// file keeps its comments and spaces, directives and the text that they exclude become empty
/// lines, and the tokens of a macro are where the macro was used.
class TextBuilder {
public:
  TextBuilder(const clang::Preprocessor &preprocessor, Origins &origins,
              const SourceManager &sources, FileId file);

  /// Adds the next token or comment.
  void add(const clang::Token &token);
  /// Leaves out a use of a macro, or what an `#if` skipped, from `begin` to `end`. In the order of
  /// the file.
  void addGap(clang::SourceLocation begin, clang::SourceLocation end, bool isDirective);
  /// Takes the rest of the file that is preprocessed.
  ExpandedText finish(clang::FileID mainFile);

private:
  struct Gap {
    std::uint32_t begin, end;
    bool isDirective;
  };
  /// The position in a file that was included, for each inclusion.
  struct Progress {
    FileId file = 0;
    std::uint32_t include = 0;
    std::uint32_t end = 0;
    std::vector<Gap> gaps; // those still ahead
    std::size_t nextGap = 0;
  };
  Progress &progressIn(clang::FileID id);
  void advance(Progress &progress, std::uint32_t to);
  std::uint32_t skipDirective(Progress &progress, std::string_view text, std::uint32_t at,
                              std::uint32_t to);
  bool continuesAt(const Progress &progress, std::uint32_t begin) const;
  void append(const Progress &progress, std::uint32_t begin, std::uint32_t end);
  void append(std::string_view words, const Origin &origin);
  void separate(std::string_view next);

  const clang::Preprocessor &preprocessor;
  const clang::SourceManager &locations;
  Origins &origins;
  const SourceManager &sources;
  llvm::DenseMap<clang::FileID, Progress> files;
  clang::FileID lastFile;
  clang::SourceLocation use; // of the macro that the last token came from
  ExpandedText result;
};

} // namespace rtsl
