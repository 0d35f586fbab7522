//===- TextBuilder.cpp - tokens to an expanded text -----------------------===//
//
// Between two tokens of a file are spaces, and also what the preprocessor dropped: directives, the
// parts that `#if` skipped, uses of macros with empty expansions. Comments count as tokens here, so
// that a `#` between two tokens always begins a directive.
//
//===----------------------------------------------------------------------===//
#include "TextBuilder.h"

#include "support/ByteOrderMark.h"

#include <llvm/ADT/SmallString.h>

#include <algorithm>

namespace rtsl {

namespace {

bool isWordCharacter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
         c == '.' || static_cast<unsigned char>(c) >= 0x80;
}

bool isSpace(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f' || c == '\v';
}

bool isBracketOrSeparator(char c) {
  return std::string_view("()[]{};,").find(c) != std::string_view::npos;
}

/// True if two tokens would be read as one, or as different ones, without a space between them.
bool needSpace(char last, char first) {
  if (isSpace(last) || isSpace(first) || isBracketOrSeparator(last) || isBracketOrSeparator(first))
    return false;
  return isWordCharacter(last) == isWordCharacter(first);
}

/// Size of a backslash and the line end after it; 0 if there is none at `at`.
std::uint32_t continuationAt(std::string_view text, std::uint32_t at) {
  if (text[at] != '\\' || at + 1 >= text.size())
    return 0;
  if (text[at + 1] == '\n')
    return 2;
  return text[at + 1] == '\r' && at + 2 < text.size() && text[at + 2] == '\n' ? 3 : 0;
}

} // namespace

TextBuilder::TextBuilder(const clang::Preprocessor &preprocessor, Origins &origins,
                         const SourceManager &sources, FileId file)
    : preprocessor(preprocessor), locations(preprocessor.getSourceManager()), origins(origins),
      sources(sources) {
  result.file = file;
  result.text.reserve(sources.text(file).size());
  result.pieces.push_back({0, {{file, 0, 0}, 0}, true});
}

TextBuilder::Progress &TextBuilder::progressIn(clang::FileID id) {
  auto [entry, isNew] = files.try_emplace(id);
  Progress &progress = entry->second;
  if (isNew) {
    progress.file = origins.fileOf(id);
    progress.include = origins.includeOf(id);
    progress.end = std::uint32_t(byteOrderMarkLength(sources.text(progress.file)));
  }
  return progress;
}

/// True if the text ends with what precedes `begin` in a file.
bool TextBuilder::continuesAt(const Progress &progress, std::uint32_t begin) const {
  const Piece &last = result.pieces.back();
  return last.isVerbatim && last.origin.range.file == progress.file &&
         last.origin.expansion == progress.include && last.origin.range.end == begin &&
         result.text.size() - last.begin == last.origin.range.end - last.origin.range.begin;
}

/// Appends the bytes [begin, end) of a file.
void TextBuilder::append(const Progress &progress, std::uint32_t begin, std::uint32_t end) {
  if (begin >= end)
    return;
  if (continuesAt(progress, begin))
    result.pieces.back().origin.range.end = end;
  else
    result.pieces.push_back({static_cast<std::uint32_t>(result.text.size()),
                             {{progress.file, begin, end}, progress.include},
                             true});
  result.text += sources.text({progress.file, begin, end});
}

/// Appends tokens whose text is not in a file.
void TextBuilder::append(std::string_view words, const Origin &origin) {
  result.pieces.push_back({static_cast<std::uint32_t>(result.text.size()), origin, false});
  result.text += words;
}

void TextBuilder::separate(std::string_view next) {
  if (!result.text.empty() && !next.empty() && needSpace(result.text.back(), next.front()))
    result.text += ' ';
}

void TextBuilder::addGap(clang::SourceLocation begin, clang::SourceLocation end, bool isDirective) {
  const clang::FileIDAndOffset first = locations.getDecomposedLoc(begin);
  const clang::FileIDAndOffset last = locations.getDecomposedLoc(end);
  if (first.first != last.first || origins.fileOf(first.first) == 0)
    return;
  Progress &progress = progressIn(first.first);
  // The condition of an `#if` is read before it is known what is skipped.
  const auto at = std::upper_bound(
      progress.gaps.begin() + static_cast<std::ptrdiff_t>(progress.nextGap), progress.gaps.end(),
      first.second, [](std::uint32_t offset, const Gap &gap) { return offset < gap.begin; });
  progress.gaps.insert(at, {first.second, last.second, isDirective});
}

/// Skips a directive, to the end of its line, and the text that it excludes.
std::uint32_t TextBuilder::skipDirective(Progress &progress, std::string_view text,
                                         std::uint32_t at, std::uint32_t to) {
  while (at < to && text[at] != '\n') {
    while (progress.nextGap < progress.gaps.size() && progress.gaps[progress.nextGap].begin < at)
      ++progress.nextGap;
    if (progress.nextGap < progress.gaps.size() && progress.gaps[progress.nextGap].begin == at &&
        progress.gaps[progress.nextGap].isDirective) {
      const Gap &gap = progress.gaps[progress.nextGap++];
      at = std::max(at + 1, std::min(gap.end, to));
    } else if (const std::uint32_t size = continuationAt(text, at)) {
      at += size;
    } else if (text.substr(at, 2) == "/*") {
      const std::size_t end = text.find("*/", at + std::size_t{2});
      at = end == std::string_view::npos ? to : std::min(static_cast<std::uint32_t>(end + 2), to);
    } else if (text.substr(at, 2) == "//") {
      while (at < to && text[at] != '\n')
        at += std::max(1u, continuationAt(text, at));
    } else {
      ++at;
    }
  }
  return std::min(at, to);
}

/// Takes the text between the last token of a file and the next one.
void TextBuilder::advance(Progress &progress, std::uint32_t to) {
  const std::string_view text = sources.text(progress.file);
  to = std::min(to, static_cast<std::uint32_t>(text.size()));
  std::uint32_t taken = progress.end;
  const auto drop = [&](std::uint32_t begin, std::uint32_t end) {
    append(progress, taken, begin);
    const std::string_view dropped = text.substr(begin, end - begin);
    result.text.append(static_cast<std::size_t>(std::count(dropped.begin(), dropped.end(), '\n')),
                       '\n');
    taken = end;
  };
  for (std::uint32_t at = progress.end; at < to;) {
    while (progress.nextGap < progress.gaps.size() && progress.gaps[progress.nextGap].begin < at)
      ++progress.nextGap;
    std::uint32_t end = at;
    if (text[at] == '#')
      end = skipDirective(progress, text, at, to);
    else if (progress.nextGap < progress.gaps.size() && progress.gaps[progress.nextGap].begin == at)
      end = std::min(progress.gaps[progress.nextGap++].end, to);
    else if (text[at] == '\\')
      end = std::min(at + continuationAt(text, at), to);
    if (end > at)
      drop(at, end);
    at = std::max(at + 1, end);
  }
  append(progress, taken, to);
  progress.end = std::max(progress.end, to);
  if (progress.nextGap == progress.gaps.size()) {
    progress.gaps.clear();
    progress.nextGap = 0;
  }
}

void TextBuilder::add(const clang::Token &token) {
  const clang::SourceLocation location = token.getLocation();
  const clang::CharSourceRange written = locations.getExpansionRange(location);
  const clang::FileIDAndOffset begin = locations.getDecomposedLoc(written.getBegin());
  Progress &progress = progressIn(begin.first);
  if (progress.file == 0)
    return;
  if (begin.first != lastFile) {
    // An empty line, so that a comment before the `#include` is not attached to the first
    // declaration in the file.
    if (!result.text.empty() && result.text.back() != '\n')
      result.text += '\n';
    if (lastFile.isValid())
      result.text += '\n';
    lastFile = begin.first;
    use = {};
  }

  if (location.isFileID() && !token.needsCleaning()) {
    use = {};
    advance(progress, begin.second);
    const std::uint32_t end = begin.second + token.getLength();
    if (!continuesAt(progress, begin.second))
      separate(sources.text({progress.file, begin.second, end}));
    append(progress, begin.second, end);
    progress.end = std::max(progress.end, end);
    return;
  }
  const bool isFirst = location.isFileID() || use != written.getBegin();
  if (isFirst) {
    advance(progress, begin.second);
    const clang::FileIDAndOffset end = locations.getDecomposedLoc(written.getEnd());
    const std::uint32_t size =
        location.isFileID() ? token.getLength() : origins.sizeAt(written.getEnd());
    progress.end = std::max(progress.end, end.second + size);
    use = location.isFileID() ? clang::SourceLocation() : written.getBegin();
  }
  llvm::SmallString<64> buffer;
  const llvm::StringRef words = preprocessor.getSpelling(token, buffer);
  if (!isFirst && (token.hasLeadingSpace() || token.isAtStartOfLine()) && !result.text.empty() &&
      !isSpace(result.text.back()))
    result.text += ' ';
  separate({words.data(), words.size()});
  append({words.data(), words.size()}, origins.of(location, token.getLength()));
}

ExpandedText TextBuilder::finish(clang::FileID mainFile) {
  Progress &progress = progressIn(mainFile);
  if (lastFile.isValid() && lastFile != mainFile && !result.text.empty() &&
      result.text.back() != '\n')
    result.text += '\n';
  advance(progress, static_cast<std::uint32_t>(sources.text(progress.file).size()));
  result.expansions = std::move(origins.expansions);
  return std::move(result);
}

} // namespace rtsl
