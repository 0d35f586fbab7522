//===- TextBuilder.h - words to an expanded text --------------------------===//
#pragma once

#include "Origins.h"

#include <clang/Lex/Preprocessor.h>

#include <llvm/ADT/DenseMap.h>

#include <vector>

namespace rtsl {

/// Puts together what the preprocessor gives, so that it reads as the author wrote it: what comes
/// from a file is taken over with its comments and spaces, directives and what they leave out
/// become empty lines, and the words of a macro stand where the macro was used.
class TextBuilder {
public:
  TextBuilder(const clang::Preprocessor &preprocessor, Origins &origins,
              const SourceManager &sources, FileId file);

  /// The next word or comment.
  void add(const clang::Token &token);
  /// A use of a macro, or what an `#if` left out, from `begin` to `end`: no part of the text. In
  /// the order of the file.
  void addGap(clang::SourceLocation begin, clang::SourceLocation end, bool isDirective);
  /// Takes the rest of the file that is preprocessed.
  ExpandedText finish(clang::FileID mainFile);

private:
  struct Gap {
    std::uint32_t begin, end;
    bool isDirective;
  };
  /// How far a file, as it was included once, has been taken.
  struct Progress {
    FileId file = 0;
    std::uint32_t include = 0;
    std::uint32_t end = 0;
    std::vector<Gap> gaps; // that are still to come
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
  clang::SourceLocation use; // of the macro that the last word came from
  ExpandedText result;
};

} // namespace rtsl
