//===- SourceNotes.h - what only the author's text has --------------------===//
//
// The typed tree has no parentheses, no empty lines and no comments after a declaration on the
// same line. Its nodes have source ranges, by which the text is read.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "frontend/source/Source.h"

#include <string>

namespace rtsl::cpp {

class SourceNotes {
public:
  explicit SourceNotes(const SourceManager &sources) : sources(sources) {}

  /// Do parentheses stand around the text, inside of the range or directly outside?
  bool inParentheses(SourceRange range) const;
  /// The text, if it is one identifier; otherwise empty.
  std::string identifier(SourceRange range) const;
  /// The comment that ends the line on which the range ends, with its markers; empty: none. Only
  /// where nothing but punctuation and initialisers stands between. Lines below continue it that
  /// hold only a comment, in the same column.
  std::string trailingComment(SourceRange range) const;
  /// Is there an empty line above the text, or above the comment directly above it? Not if it
  /// stands on the line of what comes before.
  bool followsEmptyLine(SourceRange range, SourceRange previous) const;
  /// File and line, for #line.
  std::string file(SourceRange range) const;
  unsigned line(SourceRange range) const;
  /// The name of the file that messages about a range would show.
  std::string shownFile(SourceRange range) const;
  /// The text of a line of the file in which the range is, without comment and white space around
  /// it.
  std::string textOfLine(SourceRange range, unsigned line) const;

private:
  const SourceManager &sources;
};

} // namespace rtsl::cpp
