//===- Expansion.h - texts that the preprocessor made, and where they come from -===//
//
// The preprocessor makes one text of a file, its includes and its macros. The text consists of
// pieces; each of them knows the range of a file that it was written at, and how it came from
// there: through `#include`, as part of the body of a macro, or as its argument. These ways are a
// tree of `Expansion`s, with the file itself at the root.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "frontend/source/Source.h"

namespace rtsl {

/// A range of a file, and the way from there into an expanded text: an index into its expansions.
struct Origin {
  SourceRange range;
  std::uint32_t expansion = 0;
};

struct Expansion {
  enum Kind : std::uint8_t {
    File,     // the file that is preprocessed; always the first
    Include,  // `at`: the name of the file in the directive
    Macro,    // a word of the body of `macro`; `at`: the use of the macro, arguments included
    Argument, // a word of an argument of `macro`; `at`: the parameter in the body
  };
  Kind kind = File;
  std::string macro;
  Origin at;
  std::uint32_t writtenIn = 0; // Argument: the expansion in which the argument stands
};

/// A part of an expanded text, up to the beginning of the next one. The spaces at its end may be
/// the preprocessor's.
struct Piece {
  std::uint32_t begin = 0;
  Origin origin;
  bool isVerbatim = true; // byte for byte what stands at the origin
};

struct ExpandedText {
  FileId file = 0; // that was preprocessed
  std::string text;
  std::vector<Piece> pieces; // by `begin`; the first one begins at 0
  std::vector<Expansion> expansions{1};
};

/// Where a range of an expanded text was written.
struct WrittenRange {
  /// In a file: the words themselves, the arguments that they came from, or the use of the macro
  /// that they came from.
  SourceRange range;
  /// The bytes at `range` are those that were asked for.
  bool isVerbatim = true;

  /// A place in the definition of a macro.
  struct MacroPlace {
    std::string_view macro;
    SourceRange range;
  };
  /// From the macro used at `range` to the one whose body holds the words; empty for what came from
  /// no macro.
  std::vector<MacroPlace> macros;
  /// The `#include`s that led to the file of `range`, the innermost first.
  std::vector<SourceRange> includes;
};

/// For the range [begin, end) of the text. An empty range lies behind what stands in front of it.
WrittenRange written(const ExpandedText &text, std::uint32_t begin, std::uint32_t end);

/// For a single word.
WrittenRange written(const std::vector<Expansion> &expansions, const Origin &origin);

/// Where a user looks for the beginning of a range: out of macros, as `#line` says.
ShownPlace shownBegin(const SourceManager &sources, SourceRange range);

} // namespace rtsl
