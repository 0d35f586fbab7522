//===- PrintPreprocessed.cpp - printing an expanded text ------------------===//
#include "Preprocessor.h"
#include "frontend/source/Expansion.h"

namespace rtsl {

namespace {

/// A name between quotes.
std::string quoted(std::string_view name) {
  std::string result = "\"";
  for (const char c : name) {
    if (c == '"' || c == '\\')
      result += '\\';
    result += c;
  }
  return result + "\"";
}

bool isBlank(std::string_view line) {
  return line.find_first_not_of(" \t\r") == std::string_view::npos;
}

} // namespace

std::string printPreprocessed(FileId text, const SourceManager &sources) {
  const std::string_view all = sources.text(text);
  std::string result;
  std::string_view file = sources.name(text);
  std::uint32_t line = 1; // of `file`: the current line for the reader
  bool isFirst = true;
  for (std::size_t begin = 0; begin < all.size();) {
    const std::size_t end = std::min(all.find('\n', begin), all.size());
    const std::string_view content = all.substr(begin, end - begin);
    const auto word = static_cast<std::uint32_t>(
        std::min(content.find_first_not_of(" \t\r"), content.size()) + begin);
    if (!isBlank(content)) {
      const ShownPlace place = shownBegin(sources, {text, word, word + 1});
      // Some empty lines read better than a directive.
      constexpr std::uint32_t maxEmptyLines = 8;
      if (place.file == file && place.at.line >= line && place.at.line - line <= maxEmptyLines) {
        result.append(isFirst ? 0 : place.at.line - line, '\n');
        if (isFirst && place.at.line > line)
          result += fmt::format("#line {} {}\n", place.at.line, quoted(place.file));
      } else {
        result += fmt::format("#line {} {}\n", place.at.line, quoted(place.file));
      }
      file = place.file;
      line = place.at.line;
      result += content;
      result += '\n';
      ++line;
      isFirst = false;
    }
    begin = end + 1;
  }
  return result;
}

} // namespace rtsl
