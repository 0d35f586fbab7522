//===- Source.h - source texts and positions in them ----------------------===//
//
// Every text that a message can point into (RTSL files, scene files) is held by one
// `SourceManager`. A position is a file and a byte offset; lines and columns are computed only when
// a message is shown.
//
// The output of the preprocessor for a file is a text as well (Expansion.h): all later stages read
// it, and their positions refer to it. Where the author wrote a range is computed when a message is
// shown: `written`.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace rtsl {

/// A text in a `SourceManager`. Zero is "no file": a message without a position, such as a bad
/// argument.
using FileId = std::uint32_t;

/// The half-open range of bytes [begin, end) of one text.
struct SourceRange {
  FileId file = 0;
  std::uint32_t begin = 0;
  std::uint32_t end = 0;

  bool isValid() const { return file != 0; }
  /// The smallest range that contains both; both must be in the same file.
  SourceRange to(SourceRange last) const { return {file, begin, last.end}; }
  bool operator==(const SourceRange &other) const {
    return file == other.file && begin == other.begin && end == other.end;
  }
};

/// Line and column, both counted from 1; the column counts bytes.
struct LineColumn {
  std::uint32_t line = 1;
  std::uint32_t column = 1;
};

/// A position as messages show it: `#line` may have changed the file's name and the line.
struct ShownPlace {
  std::string_view file;
  LineColumn at;
};

struct ExpandedText;
struct WrittenRange;

/// Owns the texts. Texts are never moved: a `string_view` into one is valid as long as the manager
/// exists.
class SourceManager {
public:
  /// Adds a text under the name that messages show (the path as the user gave it).
  FileId add(std::string name, std::string text);

  /// Reads a file and adds it; "-" is standard input. On failure returns no id and sets `whyNot` to
  /// the operating system's message.
  std::optional<FileId> addFile(const std::string &path, std::string &whyNot);

  /// Ids range from 1 to this.
  FileId count() const { return static_cast<FileId>(files.size()); }

  /// Adds the preprocessor's output for a file.
  FileId addExpanded(ExpandedText text);
  /// The preprocessor's output; null for a file.
  const ExpandedText *expanded(FileId file) const { return get(file).expanded.get(); }
  /// Where a range of any text was written.
  WrittenRange written(SourceRange range) const;

  /// `#line`: from `offset`, the beginning of a line, lines are shown with the numbers from `line`
  /// on and as those of the file `name`.
  void setLine(FileId file, std::uint32_t offset, std::uint32_t line, std::string name);

  std::string_view name(FileId file) const;
  std::string_view text(FileId file) const;
  std::string_view text(SourceRange range) const;
  LineColumn lineColumn(FileId file, std::uint32_t offset) const;
  ShownPlace shown(FileId file, std::uint32_t offset) const;
  /// The inverse; a position after the end of its line or of the text gives that end.
  std::uint32_t offset(FileId file, LineColumn place) const;
  /// The file of that name, if there is one; otherwise 0.
  FileId find(std::string_view name) const;
  /// The text of a line (counted from 1), without its line ending.
  std::string_view line(FileId file, std::uint32_t line) const;

private:
  struct LineMark { // of `#line`
    std::uint32_t offset, line;
    std::string name;
  };
  struct File {
    std::string name;
    std::string text;
    std::shared_ptr<const ExpandedText> expanded;  // `text` is empty then
    std::vector<LineMark> lineMarks;               // by offset
    mutable std::vector<std::uint32_t> lineStarts; // filled on first use
  };
  const File &get(FileId file) const;
  const std::vector<std::uint32_t> &lineStarts(FileId file) const;

  std::deque<File> files;
};

} // namespace rtsl
