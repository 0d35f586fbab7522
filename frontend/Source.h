//===- Source.h - source texts and positions in them ----------------------===//
//
// Every text that a message can point into (RTSL files, scene files) is held by one
// `SourceManager`. A position is a file and a byte offset; lines and columns are computed only when
// a message is shown.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace rtsl {

/// A text in a `SourceManager`. Zero is "no file": a message without a place, such as a bad
/// argument.
using FileId = std::uint32_t;

/// The half-open range of bytes [begin, end) of one text.
struct SourceRange {
  FileId file = 0;
  std::uint32_t begin = 0;
  std::uint32_t end = 0;

  bool isValid() const { return file != 0; }
  /// The smallest range that holds both; both must lie in the same file.
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

/// Owns the texts. Texts stay where they are: a `string_view` into one lives as long as the
/// manager.
class SourceManager {
public:
  /// Adds a text under the name that messages show (the path as the user gave it).
  FileId add(std::string name, std::string text);

  /// Reads a file and adds it; "-" is standard input. On failure returns no id and says why in
  /// `whyNot` (as the operating system puts it).
  std::optional<FileId> addFile(const std::string &path, std::string &whyNot);

  /// Ids are 1 to this.
  FileId count() const { return static_cast<FileId>(files.size()); }

  std::string_view name(FileId file) const;
  std::string_view text(FileId file) const;
  std::string_view text(SourceRange range) const;
  LineColumn lineColumn(FileId file, std::uint32_t offset) const;
  /// The other way round; a place behind the end of its line or of the text gives that end.
  std::uint32_t offset(FileId file, LineColumn place) const;
  /// The text of that name, if there is one; otherwise 0.
  FileId find(std::string_view name) const;
  /// The text of a line (counted from 1), without its line ending.
  std::string_view line(FileId file, std::uint32_t line) const;

private:
  struct File {
    std::string name;
    std::string text;
    mutable std::vector<std::uint32_t> lineStarts; // filled at the first question
  };
  const File &get(FileId file) const;
  static const std::vector<std::uint32_t> &lineStarts(const File &file);

  std::deque<File> files;
};

} // namespace rtsl
