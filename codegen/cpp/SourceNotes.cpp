#include "codegen/cpp/SourceNotes.h"

#include "frontend/source/Expansion.h"

#include <algorithm>
#include <cctype>

namespace rtsl::cpp {

static bool isSpace(char c) {
  return std::isspace(static_cast<unsigned char>(c)) != 0;
}

bool SourceNotes::inParentheses(SourceRange range) const {
  if (!range.isValid())
    return false;
  const std::string_view text = sources.text(range.file);
  if (text[range.begin] == '(' && text[range.end - 1] == ')') {
    int depth = 0;
    std::size_t at = range.begin;
    for (; at < range.end; ++at) {
      depth += text[at] == '(' ? 1 : text[at] == ')' ? -1 : 0;
      if (depth == 0)
        break;
    }
    if (at + 1 == range.end)
      return true;
  }
  std::size_t before = range.begin, after = range.end;
  while (before > 0 && isSpace(text[before - 1]))
    --before;
  while (after < text.size() && isSpace(text[after]))
    ++after;
  return before > 0 && after < text.size() && text[before - 1] == '(' && text[after] == ')';
}

/// The comment that begins at `begin`, and those that continue it: on the lines below, alone and in
/// the same column.
static std::string wholeComment(std::string_view text, std::size_t begin) {
  const std::size_t lineBegin = text.rfind('\n', begin) + 1; // 0 on the first line
  const std::size_t column = begin - lineBegin;
  std::string whole;
  for (std::size_t at = lineBegin; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    std::string_view line = text.substr(at, end - at);
    while (!line.empty() && isSpace(line.back()))
      line.remove_suffix(1);
    const std::string_view before = line.substr(0, std::min(column, line.size()));
    const bool isAlone = std::all_of(before.begin(), before.end(), isSpace);
    if (line.size() < column + 2 || line.compare(column, 2, "//") != 0 ||
        (!whole.empty() && !isAlone))
      break;
    whole += whole.empty() ? "" : "\n";
    whole += line.substr(column);
    at = end + 1;
  }
  return whole;
}

std::string SourceNotes::trailingComment(SourceRange range) const {
  if (!range.isValid())
    return {};
  const std::string_view text = sources.text(range.file);
  const std::size_t end = std::min(text.find('\n', range.end), text.size());
  const std::string_view rest = text.substr(range.end, end - range.end);
  const std::size_t comment = rest.find("//");
  if (comment == std::string_view::npos)
    return {};
  const std::size_t semicolon = rest.find(';');
  const bool isLast = semicolon == std::string_view::npos || semicolon > comment ||
                      rest.find_first_not_of(" \t", semicolon + 1) == comment;
  if (!isLast)
    return {};
  return wholeComment(text, range.end + comment);
}

std::string SourceNotes::identifier(SourceRange range) const {
  if (!range.isValid())
    return {};
  const std::string_view text = sources.text(range);
  auto isWord = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  const bool isName = !text.empty() &&
                      std::isdigit(static_cast<unsigned char>(text.front())) == 0 &&
                      std::all_of(text.begin(), text.end(), isWord);
  return isName ? std::string(text) : std::string();
}

bool SourceNotes::followsEmptyLine(SourceRange range, SourceRange previous) const {
  if (!range.isValid())
    return false;
  unsigned line = sources.lineColumn(range.file, range.begin).line;
  if (previous.isValid() && previous.file == range.file &&
      sources.lineColumn(range.file, previous.end).line == line)
    return false;
  while (line > 1) {
    std::string_view above = sources.line(range.file, line - 1);
    while (!above.empty() && isSpace(above.front()))
      above.remove_prefix(1);
    if (above.empty())
      return true;
    if (above.compare(0, 2, "//") != 0)
      return false;
    --line;
  }
  return false;
}

std::string SourceNotes::file(SourceRange range) const {
  return std::string(sources.name(range.file));
}

std::string SourceNotes::shownFile(SourceRange range) const {
  return std::string(shownBegin(sources, range).file);
}

std::string SourceNotes::textOfLine(SourceRange range, unsigned line) const {
  if (!range.isValid() || line == 0)
    return {};
  std::string_view text = sources.line(range.file, line);
  text = text.substr(0, text.find("//"));
  while (!text.empty() && isSpace(text.front()))
    text.remove_prefix(1);
  while (!text.empty() && (isSpace(text.back()) || text.back() == ';' || text.back() == '{'))
    text.remove_suffix(1);
  return std::string(text);
}

unsigned SourceNotes::line(SourceRange range) const {
  return sources.lineColumn(range.file, range.begin).line;
}

} // namespace rtsl::cpp
