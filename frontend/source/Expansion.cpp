//===- Expansion.cpp - from expanded texts to what the author wrote -------===//
#include "frontend/source/Expansion.h"

#include <algorithm>

namespace rtsl {

namespace {

/// The chain of expansions from a token in a file to the text.
struct Path {
  struct Step {
    std::uint32_t expansion; // of the macro's body
    std::string_view macro;
    // in the definition: the token, the parameter that it replaces, or the use of the next macro
    SourceRange range;
  };
  Origin word;             // in a file: the token or the use of the macro that it came from
  Origin use;              // in a file: the use of the outermost macro; `word` if there is none
  std::vector<Step> steps; // the outermost first

  bool isArgument() const { return !(word.range == use.range); }
};

bool isMacro(Expansion::Kind kind) {
  return kind == Expansion::Macro || kind == Expansion::Argument;
}

Path pathOf(const std::vector<Expansion> &expansions, Origin origin) {
  Path path;
  std::uint32_t outermost = 0; // the body of the outermost macro
  while (isMacro(expansions[origin.expansion].kind)) {
    const Expansion &expansion = expansions[origin.expansion];
    if (expansion.kind == Expansion::Macro) {
      path.steps.push_back({origin.expansion, expansion.macro, origin.range});
      outermost = origin.expansion;
      origin = expansion.at;
    } else {
      path.steps.push_back({expansion.at.expansion, expansion.macro, expansion.at.range});
      outermost = expansion.at.expansion;
      origin.expansion = expansion.writtenIn;
    }
  }
  std::reverse(path.steps.begin(), path.steps.end());
  path.word = path.use = origin;
  while (isMacro(expansions[outermost].kind)) {
    path.use = expansions[outermost].at;
    outermost = path.use.expansion;
  }
  return path;
}

SourceRange join(SourceRange first, SourceRange last) {
  return first.file == last.file && first.begin <= last.end ? first.to(last) : first;
}

/// The range from the token at the end of `first` to that at the end of `last`.
WrittenRange between(const std::vector<Expansion> &expansions, const Path &first,
                     const Path &last) {
  WrittenRange result;
  const bool isOneUse = !first.steps.empty() && !last.steps.empty() &&
                        first.use.range == last.use.range &&
                        first.use.expansion == last.use.expansion;
  if (!isOneUse) {
    result.range = join(first.use.range, last.use.range);
  } else if (first.word.range == last.word.range ||
             (first.isArgument() && last.isArgument() &&
              first.word.range.end <= last.word.range.begin)) {
    result.range = join(first.word.range, last.word.range);
  } else {
    result.range = first.use.range;
  }
  // The common part of their chains; after the first difference nothing more can be shown.
  for (std::size_t i = 0; isOneUse && i < std::min(first.steps.size(), last.steps.size()); ++i) {
    const Path::Step &a = first.steps[i], &b = last.steps[i];
    if (a.expansion != b.expansion)
      break;
    result.macros.push_back({a.macro, join(a.range, b.range)});
  }
  for (Origin at = first.word; expansions[at.expansion].kind == Expansion::Include;) {
    at = expansions[at.expansion].at;
    result.includes.push_back(at.range);
    while (isMacro(expansions[at.expansion].kind)) // the name of the file came from a macro
      at = expansions[at.expansion].at;
  }
  return result;
}

/// The origin of one byte, as an empty range, or of the whole token if its text is not in a file.
Origin originOf(const Piece &piece, std::uint32_t offset) {
  Origin origin = piece.origin;
  if (piece.isVerbatim)
    origin.range.begin = origin.range.end =
        std::min(origin.range.begin + (offset - piece.begin), origin.range.end);
  return origin;
}

} // namespace

WrittenRange written(const std::vector<Expansion> &expansions, const Origin &origin) {
  const Path path = pathOf(expansions, origin);
  WrittenRange result = between(expansions, path, path);
  result.isVerbatim = path.steps.empty();
  return result;
}

WrittenRange written(const ExpandedText &text, std::uint32_t begin, std::uint32_t end) {
  const auto size = static_cast<std::uint32_t>(text.text.size());
  begin = std::min(begin, size);
  end = std::clamp(end, begin, size);
  const auto pieceOf = [&](std::uint32_t offset) {
    const auto next =
        std::upper_bound(text.pieces.begin(), text.pieces.end(), offset,
                         [](std::uint32_t o, const Piece &piece) { return o < piece.begin; });
    return std::prev(next);
  };
  if (begin ==
      end) { // after the previous byte, unless that is from a macro and the next one is not
    const auto after = pieceOf(begin);
    const auto before = begin > 0 ? pieceOf(begin - 1) : after;
    const Piece &piece = !before->isVerbatim && after->isVerbatim ? *after : *before;
    WrittenRange result = written(text.expansions, originOf(piece, begin));
    result.range.begin = result.range.end;
    result.isVerbatim = piece.isVerbatim;
    return result;
  }
  const auto first = pieceOf(begin), last = pieceOf(end - 1);
  Origin from = originOf(*first, begin), to = originOf(*last, end);
  from.range.end = first == last ? to.range.end : first->origin.range.end;
  to.range.begin = first == last ? from.range.begin : last->origin.range.begin;
  WrittenRange result =
      between(text.expansions, pathOf(text.expansions, from), pathOf(text.expansions, to));
  result.isVerbatim = first == last && first->isVerbatim;
  return result;
}

ShownPlace shownBegin(const SourceManager &sources, SourceRange range) {
  const SourceRange place = sources.written(range).range;
  return sources.shown(place.file, place.begin);
}

} // namespace rtsl
