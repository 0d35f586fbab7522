//===- Expansion.h - texts that the preprocessor made, and where they come from -===//
//
// The preprocessor makes one text of a file, its includes and its macros. The text consists of
// pieces; each has the range of a file where it was written, and how it was expanded from there:
// through `#include`, as part of the body of a macro, or as its argument. These chains form a tree
// of `Expansion`s, with the file itself at the root.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "frontend/source/Source.h"

namespace rtsl {

/// A range of a file, and its chain into an expanded text: an index into its expansions.
struct Origin {
  SourceRange range;
  std::uint32_t expansion = 0;
};

struct Expansion {
  enum Kind : std::uint8_t {
    File,     // the file that is preprocessed; always the first
    Include,  // `at`: the name of the file in the directive
    Macro,    // a token of the body of `macro`; `at`: the use of the macro, arguments included
    Argument, // a token of an argument of `macro`; `at`: the parameter in the body
  };
  Kind kind = File;
  std::string macro;
  Origin at;
  std::uint32_t writtenIn = 0; // Argument: the expansion that contains the argument
};

/// A part of an expanded text, up to the beginning of the next one. Spaces at its end may come from
/// the preprocessor.
struct Piece {
  std::uint32_t begin = 0;
  Origin origin;
  bool isVerbatim = true; // byte for byte the text at the origin
};

struct ExpandedText {
  FileId file = 0; // that was preprocessed
  std::string text;
  std::vector<Piece> pieces; // by `begin`; the first one begins at 0
  std::vector<Expansion> expansions{1};
};

/// Where a range of an expanded text was written.
struct WrittenRange {
  /// In a file: the tokens themselves, the arguments that they came from, or the use of the macro
  /// that they came from.
  SourceRange range;
  /// The bytes at `range` are exactly those of the requested range.
  bool isVerbatim = true;

  /// A range in the definition of a macro.
  struct MacroPlace {
    std::string_view macro;
    SourceRange range;
  };
  /// The macros, from the one used at `range` to the one whose body holds the tokens; empty if no
  /// macro is involved.
  std::vector<MacroPlace> macros;
  /// The `#include`s that led to the file of `range`, the innermost first.
  std::vector<SourceRange> includes;
};

/// Where the range [begin, end) of the text was written. An empty range is placed after the byte
/// before it.
WrittenRange written(const ExpandedText &text, std::uint32_t begin, std::uint32_t end);

/// The same for a single token.
WrittenRange written(const std::vector<Expansion> &expansions, const Origin &origin);

/// Where the author finds the beginning of a range: outside of macros, with `#line` applied.
ShownPlace shownBegin(const SourceManager &sources, SourceRange range);

} // namespace rtsl
