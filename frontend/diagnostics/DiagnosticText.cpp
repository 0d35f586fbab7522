//===- DiagnosticText.cpp - messages for people ---------------------------===//
//
// A message as it is shown:
//
//   glass.rtsl:12:18: error[E0113]: `(` is never closed
//      |
//   12 |   color c = mix(a, (b + 1);
//      |                ^
//      |                |
//      |                opened here
//      = note: ...
//   help: insert `)`
//      |
//   12 |   color c = mix(a, (b + 1));
//      |                           +
//
// Source text is shown as terminal cells: tabs extend to the next multiple of four, bytes that are
// not UTF-8 and control characters are written as \xNN (so that a source cannot send escape
// sequences to the terminal), and of a very long line only the part around the range is shown.
//
//===----------------------------------------------------------------------===//
#include "frontend/diagnostics/Diagnostics.h"
#include "frontend/source/Utf8.h"

#include <algorithm>
#include <map>

namespace rtsl {

namespace {

constexpr std::size_t tabWidth = 4;
/// Lines with more bytes than this are shown as a window around the range.
constexpr std::size_t maxLineBytes = 160;
/// Bytes of a long line that are shown before the range.
constexpr std::size_t bytesBefore = 50;
/// Code longer than this is not repeated in the text of a `help:` line.
constexpr std::size_t maxQuotedBytes = 40;

//===----------------------------------------------------------------------===//
// Text in cells
//===----------------------------------------------------------------------===//

/// A piece of text as a terminal shows it, and the column of each of its bytes.
struct Cells {
  std::string text;
  std::vector<std::size_t> columnOfByte; // one more than there are bytes
  std::size_t width = 0;
};

Cells toCells(std::string_view bytes, std::size_t firstColumn = 0) {
  Cells cells;
  cells.width = firstColumn;
  cells.columnOfByte.reserve(bytes.size() + 1);
  for (std::size_t at = 0; at < bytes.size();) {
    const auto byte = static_cast<unsigned char>(bytes[at]);
    const Utf8Character character = decodeUtf8(bytes.substr(at));
    for (std::size_t i = 0; i < character.size; ++i)
      cells.columnOfByte.push_back(cells.width);
    if (byte == '\t') {
      const std::size_t spaces = tabWidth - cells.width % tabWidth;
      cells.text.append(spaces, ' ');
      cells.width += spaces;
    } else if (!character.isValid) {
      cells.text += fmt::format("\\x{:02X}", byte);
      cells.width += 4;
    } else if (isUnprintable(character.codePoint)) {
      const auto code = static_cast<std::uint32_t>(character.codePoint);
      const std::string escape =
          code < 0x100 ? fmt::format("\\x{:02X}", code) : fmt::format("\\u{{{:X}}}", code);
      cells.text += escape;
      cells.width += escape.size();
    } else {
      cells.text += bytes.substr(at, character.size);
      cells.width += cellWidth(character.codePoint);
    }
    at += character.size;
  }
  cells.columnOfByte.push_back(cells.width);
  return cells;
}

std::string printable(std::string_view text) {
  return toCells(text).text;
}

/// The part [begin, end) of a line that is shown.
struct Window {
  std::size_t begin = 0, end = 0;
};

Window windowAround(std::string_view line, std::size_t place) {
  if (line.size() <= maxLineBytes)
    return {0, line.size()};
  const auto isInside = [&](std::size_t at) { // of a character of several bytes
    return at < line.size() && (static_cast<unsigned char>(line[at]) & 0xC0) == 0x80;
  };
  Window window;
  window.begin = place > bytesBefore ? place - bytesBefore : 0;
  window.begin = std::min(window.begin, line.size() - maxLineBytes);
  window.end = window.begin + maxLineBytes;
  for (int i = 0; i < 3 && window.begin < place && isInside(window.begin); ++i)
    ++window.begin;
  for (int i = 0; i < 3 && isInside(window.end); ++i)
    --window.end;
  return window;
}

//===----------------------------------------------------------------------===//
// Marks under a line
//===----------------------------------------------------------------------===//

/// The part of a range on one line: bytes [begin, end) of the line.
struct Mark {
  std::size_t begin = 0, end = 0;
  bool isPrimary = false;
  std::string text;
};

/// Colours of a terminal; empty strings if colour is off.
struct Palette {
  std::string_view severity, label, gutter, bold, help, reset;
};

class TextRenderer {
public:
  TextRenderer(const SourceManager &sources, bool colour) : sources(sources), colour(colour) {}

  void render(const Diagnostic &diagnostic);
  std::string take() { return std::move(out); }

private:
  using Lines = std::map<std::uint32_t, std::vector<Mark>>;

  void addMarks(Lines &lines, SourceRange range, bool isPrimary, const std::string &text);
  void renderLines(FileId file, const Lines &lines);
  void renderLine(FileId file, std::uint32_t number, std::vector<Mark> marks);
  void renderMarks(const Cells &cells, std::size_t windowBegin, const std::vector<Mark> &marks);
  void renderFix(const Fix &fix);

  /// The line number that is displayed for a line.
  std::uint32_t shownLine(FileId file, std::uint32_t line) const {
    return sources.shown(file, sources.offset(file, {line, 1})).at.line;
  }
  void gutter(FileId file, std::uint32_t line);
  void gutter(char separator = '|');
  void endLine();
  std::string paint(std::string_view style, std::string_view text) const {
    return style.empty() || text.empty() ? std::string(text)
                                         : fmt::format("{}{}{}", style, text, palette.reset);
  }

  const SourceManager &sources;
  const bool colour;
  Palette palette;
  std::string out;
  std::size_t gutterWidth = 1;
};

void TextRenderer::gutter(FileId file, std::uint32_t line) {
  out += paint(palette.gutter, fmt::format("{:>{}} |", shownLine(file, line), gutterWidth));
  out += ' ';
}

void TextRenderer::gutter(char separator) {
  out += paint(palette.gutter, fmt::format("{:>{}} {}", "", gutterWidth, separator));
  out += ' ';
}

void TextRenderer::endLine() {
  while (!out.empty() && out.back() == ' ')
    out.pop_back();
  out += '\n';
}

/// Splits a range into marks. Of a range over several lines the first and the last line are shown,
/// with the text at the last one.
void TextRenderer::addMarks(Lines &lines, SourceRange range, bool isPrimary,
                            const std::string &text) {
  const LineColumn first = sources.lineColumn(range.file, range.begin);
  LineColumn last = sources.lineColumn(range.file, std::max(range.begin, range.end));
  if (last.line > first.line && last.column == 1) { // up to the end of the previous line
    --last.line;
    last.column = static_cast<std::uint32_t>(sources.line(range.file, last.line).size()) + 1;
  }
  if (first.line == last.line) {
    lines[first.line].push_back({first.column - 1, last.column - 1, isPrimary, text});
    return;
  }
  const std::string_view firstLine = sources.line(range.file, first.line);
  lines[first.line].push_back(
      {first.column - 1, std::max<std::size_t>(firstLine.size(), first.column), isPrimary, ""});
  const std::size_t indent = sources.line(range.file, last.line).find_first_not_of(" \t");
  const std::size_t lastBegin = std::min<std::size_t>(indent, last.column - 1);
  lines[last.line].push_back({lastBegin, last.column - 1, isPrimary, text});
}

void TextRenderer::renderMarks(const Cells &cells, std::size_t windowBegin,
                               const std::vector<Mark> &marks) {
  struct Underline {
    std::size_t begin, end; // columns
    const Mark *mark;
  };
  std::vector<Underline> underlines;
  const auto column = [&](std::size_t byte) {
    const std::size_t at = byte < windowBegin ? 0 : byte - windowBegin;
    return cells.columnOfByte[std::min(at, cells.columnOfByte.size() - 1)];
  };
  std::size_t width = 0;
  for (const Mark &mark : marks) {
    const std::size_t begin = column(mark.begin);
    const std::size_t end = std::max(column(mark.end), begin + 1); // at least one caret
    underlines.push_back({begin, end, &mark});
    width = std::max(width, end);
  }
  std::sort(underlines.begin(), underlines.end(), [](const Underline &a, const Underline &b) {
    return a.begin != b.begin ? a.begin < b.begin : a.mark->isPrimary < b.mark->isPrimary;
  });

  std::string row(width, ' ');
  for (const bool isPrimary : {false, true})
    for (const Underline &underline : underlines)
      if (underline.mark->isPrimary == isPrimary)
        std::fill(row.begin() + static_cast<std::ptrdiff_t>(underline.begin),
                  row.begin() + static_cast<std::ptrdiff_t>(underline.end), isPrimary ? '^' : '-');
  gutter();
  for (std::size_t at = 0; at < row.size();) {
    const std::size_t end = std::min(row.find_first_not_of(row[at], at), row.size());
    const std::string_view style = row[at] == '^'   ? palette.severity
                                   : row[at] == '-' ? palette.label
                                                    : std::string_view();
    out += paint(style, std::string_view(row).substr(at, end - at));
    at = end;
  }

  // The text of the last mark follows its underline; the others hang below, the rightmost first.
  std::vector<Underline> hanging;
  for (const Underline &underline : underlines)
    if (!underline.mark->text.empty())
      hanging.push_back(underline);
  const auto style = [&](const Underline &underline) {
    return underline.mark->isPrimary ? palette.severity : palette.label;
  };
  if (!hanging.empty() && hanging.back().end == width) {
    out += ' ';
    out += paint(style(hanging.back()), printable(hanging.back().mark->text));
    hanging.pop_back();
  }
  endLine();
  const auto connectors = [&](std::size_t count) {
    std::size_t at = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (hanging[i].begin < at)
        continue; // two marks that begin at the same column share their line
      out.append(hanging[i].begin - at, ' ');
      out += paint(style(hanging[i]), "|");
      at = hanging[i].begin + 1;
    }
    return at;
  };
  for (std::size_t left = hanging.size(); left > 0; --left) {
    if (left == hanging.size()) {
      gutter();
      connectors(left);
      endLine();
    }
    const Underline &last = hanging[left - 1];
    gutter();
    std::size_t count = left - 1;
    while (count > 0 && hanging[count - 1].begin == last.begin)
      --count;
    const std::size_t at = connectors(count);
    out.append(last.begin - at, ' ');
    out += paint(style(last), printable(last.mark->text));
    endLine();
  }
}

/// Shows a line and its marks. A mark of a long line that does not fit into the window around the
/// first one gets a window of its own.
void TextRenderer::renderLine(FileId file, std::uint32_t number, std::vector<Mark> marks) {
  const std::string_view line = sources.line(file, number);
  std::stable_sort(marks.begin(), marks.end(),
                   [](const Mark &a, const Mark &b) { return a.isPrimary > b.isPrimary; });
  while (!marks.empty()) {
    const Window window = windowAround(line, marks.front().begin);
    std::vector<Mark> shown, later;
    for (Mark &mark : marks) {
      const bool fits = mark.begin >= window.begin && mark.begin <= window.end;
      mark.end = fits ? std::min(mark.end, std::max(window.end, mark.begin + 1)) : mark.end;
      (fits ? shown : later).push_back(std::move(mark));
    }
    const std::string_view dots = "...";
    const bool isCutBefore = window.begin > 0;
    Cells cells = toCells(line.substr(window.begin, window.end - window.begin),
                          isCutBefore ? dots.size() : 0);
    gutter(file, number);
    out += isCutBefore ? paint(palette.gutter, dots) : std::string();
    out += cells.text;
    out += window.end < line.size() ? paint(palette.gutter, dots) : std::string();
    endLine();
    renderMarks(cells, window.begin, shown);
    marks = std::move(later);
  }
}

void TextRenderer::renderLines(FileId file, const Lines &lines) {
  std::uint32_t previous = 0;
  for (const auto &[number, marks] : lines) {
    if (previous != 0 && number == previous + 2) { // a single line between them is shown
      const std::string_view between = sources.line(file, previous + 1);
      const Window window = windowAround(between, 0);
      gutter(file, previous + 1);
      out += toCells(between.substr(window.begin, window.end - window.begin)).text;
      out += window.end < between.size() ? paint(palette.gutter, "...") : std::string();
      endLine();
    } else if (previous != 0 && number > previous + 2) {
      out += paint(palette.gutter, "...");
      endLine();
    }
    renderLine(file, number, marks);
    previous = number;
  }
}

/// The `help:` line of a fix and the line as it is after the edit (before it, where text is only
/// removed).
void TextRenderer::renderFix(const Fix &fix) {
  const std::string_view removed = sources.text(fix.range);
  const bool isInsertion = removed.empty();
  const bool isRemoval = fix.replacement.empty();
  const auto quoted = [](std::string_view code) {
    const std::size_t begin = std::min(code.find_first_not_of(" \t\r\n"), code.size());
    code = code.substr(begin, code.find_last_not_of(" \t\r\n") + 1 - begin);
    const bool isShort =
        !code.empty() && code.size() <= maxQuotedBytes && code.find('\n') == std::string_view::npos;
    return isShort ? fmt::format("`{}`", printable(code)) : std::string("this");
  };
  std::string text =
      isInsertion ? fmt::format("insert {}", quoted(fix.replacement))
      : isRemoval ? fmt::format("remove {}", quoted(removed))
                  : fmt::format("replace {} by {}", quoted(removed), quoted(fix.replacement));
  out += fmt::format("{}: {}\n", paint(palette.help, "help"), text);
  gutter();
  endLine();

  const LineColumn begin = sources.lineColumn(fix.range.file, fix.range.begin);
  const LineColumn end = sources.lineColumn(fix.range.file, fix.range.end);
  if (begin.line != end.line || fix.replacement.find('\n') != std::string::npos) {
    // The edit changes the number of lines: only the new text is shown, one line each.
    std::string_view rest = fix.replacement;
    for (int shown = 0; !rest.empty() && shown < 8; ++shown) {
      const std::size_t size = std::min(rest.find('\n'), rest.size());
      gutter('+');
      out += printable(rest.substr(0, std::min(size, maxLineBytes)));
      endLine();
      rest.remove_prefix(std::min(size + 1, rest.size()));
    }
    return;
  }

  const std::string_view line = sources.line(fix.range.file, begin.line);
  const std::size_t from = std::min<std::size_t>(begin.column - 1, line.size());
  const std::size_t to = std::min<std::size_t>(end.column - 1, line.size());
  const Window window = windowAround(line, from);
  std::string edited(line.substr(window.begin, from - window.begin));
  const std::size_t markBegin = edited.size();
  edited += isRemoval ? removed.substr(0, maxLineBytes) : std::string_view(fix.replacement);
  const std::size_t markEnd = edited.size();
  if (to < window.end)
    edited += line.substr(to, window.end - to);

  const std::string_view dots = window.begin > 0 ? "..." : "";
  const Cells cells = toCells(edited, dots.size());
  gutter(fix.range.file, begin.line);
  out += paint(palette.gutter, dots) + cells.text;
  out += window.end < line.size() ? paint(palette.gutter, "...") : std::string();
  endLine();
  gutter();
  const std::size_t column = cells.columnOfByte[markBegin];
  out.append(column, ' ');
  out += paint(palette.help, std::string(cells.columnOfByte[markEnd] - column, isInsertion ? '+'
                                                                               : isRemoval ? '-'
                                                                                           : '~'));
  endLine();
}

void TextRenderer::render(const Diagnostic &diagnostic) {
  const bool isError = diagnostic.severity == Severity::Error;
  if (colour)
    palette = {isError                                    ? "\033[1;31m"
               : diagnostic.severity == Severity::Warning ? "\033[1;33m"
                                                          : "\033[1;36m",
               "\033[1;34m",
               "\033[34m",
               "\033[1m",
               "\033[1;32m",
               "\033[0m"};

  if (diagnostic.range.isValid()) {
    const auto [name, at] = sources.shown(diagnostic.range.file, diagnostic.range.begin);
    out += paint(palette.bold, fmt::format("{}:{}:{}: ", printable(name), at.line, at.column));
  }
  out += paint(palette.severity,
               fmt::format("{}[{}]", nameOf(diagnostic.severity), info(diagnostic.code).number));
  out += paint(palette.bold, fmt::format(": {}", printable(diagnostic.message)));
  if (const char *warning = info(diagnostic.code).warning)
    out += fmt::format(" [-W{}{}]", isError ? "error=" : "", warning);
  endLine();

  // All texts to show, beginning with that of the message. A label at the range of the message
  // replaces its text.
  std::vector<std::pair<FileId, Lines>> files;
  const auto linesOf = [&](FileId file) -> Lines & {
    for (auto &[id, lines] : files)
      if (id == file)
        return lines;
    return files.emplace_back(file, Lines()).second;
  };
  if (diagnostic.range.isValid()) {
    std::string text;
    for (const Label &label : diagnostic.labels)
      if (label.range == diagnostic.range)
        text += text.empty() ? label.text : "; " + label.text;
    addMarks(linesOf(diagnostic.range.file), diagnostic.range, true, text);
  }
  for (const Label &label : diagnostic.labels)
    if (label.range.isValid() && !(label.range == diagnostic.range))
      addMarks(linesOf(label.range.file), label.range, false, label.text);

  std::uint32_t largest = 1;
  for (const auto &[file, lines] : files)
    for (const auto &[line, marks] : lines)
      largest = std::max(largest, shownLine(file, line));
  for (const Fix &fix : diagnostic.fixes)
    largest = std::max(largest, sources.shown(fix.range.file, fix.range.begin).at.line);
  gutterWidth = fmt::formatted_size("{}", largest);

  for (const auto &[file, lines] : files) {
    if (file != diagnostic.range.file) {
      const LineColumn at{lines.begin()->first,
                          static_cast<std::uint32_t>(lines.begin()->second.front().begin) + 1};
      out.append(gutterWidth, ' ');
      out += paint(palette.gutter, "--> ");
      const ShownPlace place = sources.shown(file, sources.offset(file, at));
      out += fmt::format("{}:{}:{}", printable(place.file), place.at.line, at.column);
      endLine();
    }
    gutter();
    endLine();
    renderLines(file, lines);
  }
  for (const std::string &note : diagnostic.notes) {
    gutter('=');
    out += fmt::format("{}: {}", paint(palette.bold, "note"), printable(note));
    endLine();
  }
  for (const Fix &fix : diagnostic.fixes)
    if (fix.range.isValid())
      renderFix(fix);
  out += '\n';
}

} // namespace

std::string renderText(const Diagnostics &diagnostics, bool colour) {
  TextRenderer renderer(diagnostics.sources(), colour);
  for (const Diagnostic &diagnostic : diagnostics.all())
    renderer.render(asWritten(diagnostic, diagnostics.sources()));
  std::string text = renderer.take();
  if (const std::size_t hidden = diagnostics.hiddenErrors())
    text += fmt::format("{} more error{} not shown (limit {})\n", hidden,
                        hidden == 1 ? " is" : "s are", diagnostics.errorLimit);
  return text;
}

} // namespace rtsl
