//===- AstBuilder.cpp - parse tree to syntax tree: ranges and comments ----===//
#include "frontend/syntax/AstBuilder.h"
#include "frontend/lex/TokenStream.h"

#include <algorithm>

namespace rtsl {

AstBuilder::AstBuilder(FileId file, const std::vector<Token> &tokens,
                       const std::vector<Comment> &comments, Diagnostics &diagnostics)
    : file(file), tokens(tokens), comments(comments), diagnostics(diagnostics),
      sources(diagnostics.sources()), unit(std::make_unique<ast::TranslationUnit>()) {
  unit->file = file;
}

std::unique_ptr<ast::TranslationUnit> AstBuilder::finish() {
  // The first comment is that of the file, unless it belongs to what is directly below it.
  std::size_t last = 0;
  const std::uint32_t firstWord = tokens.front().begin;
  const std::string_view text = sources.text(file);
  const auto linesBetween = [&](std::uint32_t begin, std::uint32_t end) {
    const std::string_view between = text.substr(begin, end - begin);
    return std::count(between.begin(), between.end(), '\n');
  };
  while (last < comments.size() && comments[last].end <= firstWord && comments[last].startsLine &&
         (last == 0 || linesBetween(comments[last - 1].end, comments[last].begin) == 1))
    ++last;
  const bool isSeparate =
      last > 0 && ((last < comments.size() && comments[last].end <= firstWord) ||
                   linesBetween(comments[last - 1].end, firstWord) != 1 ||
                   tokens.front().type == Parser::IMPORT);
  if (isSeparate)
    unit->comment = commentText(0, last);
  return std::move(unit);
}

//===----------------------------------------------------------------------===//
// Ranges
//===----------------------------------------------------------------------===//

SourceRange AstBuilder::range(const antlr4::Token *token) const {
  const Token &found = static_cast<const ParserToken *>(token)->token;
  return {file, found.begin, found.end};
}

SourceRange AstBuilder::range(const antlr4::ParserRuleContext *context) const {
  const SourceRange first = range(context->start);
  if (!context->stop || context->stop->getTokenIndex() < context->start->getTokenIndex())
    return {file, first.begin, first.begin}; // nothing was read
  return {file, first.begin, range(context->stop).end};
}

ast::Name AstBuilder::name(antlr4::tree::TerminalNode *node) const {
  const SourceRange where = range(node);
  return {text(where), where};
}

//===----------------------------------------------------------------------===//
// Comments
//===----------------------------------------------------------------------===//

/// The comments [first, last), one per line, with the indentation of the text.
std::string AstBuilder::commentText(std::size_t first, std::size_t last) const {
  std::string result;
  for (std::size_t i = first; i < last; ++i) {
    const Comment &comment = comments[i];
    const std::size_t column = sources.lineColumn(file, comment.begin).column - 1;
    std::string_view rest = sources.text({file, comment.begin, comment.end});
    for (bool isFirstLine = true; !rest.empty(); isFirstLine = false) {
      const std::size_t size = std::min(rest.find('\n'), rest.size());
      std::string_view line = rest.substr(0, size);
      rest.remove_prefix(std::min(size + 1, rest.size()));
      while (!line.empty() && (line.back() == ' ' || line.back() == '\t' || line.back() == '\r'))
        line.remove_suffix(1);
      // The lines of a block comment keep their indentation relative to its first line.
      if (!isFirstLine)
        line.remove_prefix(std::min({line.find_first_not_of(" \t"), column, line.size()}));
      result += result.empty() ? "" : "\n";
      result += line;
    }
  }
  return result;
}

/// The comments on the lines directly above a declaration or statement. Those that continue a
/// comment after code, in its column, are not of what is below them.
std::string AstBuilder::commentAbove(const antlr4::ParserRuleContext *context) const {
  const std::size_t index = context->start->getTokenIndex();
  const std::uint32_t end = tokens[index].begin;
  const std::uint32_t begin = index > 0 ? tokens[index - 1].end : 0;
  const auto after = std::lower_bound(
      comments.begin(), comments.end(), end,
      [](const Comment &comment, std::uint32_t offset) { return comment.begin < offset; });
  const auto last = static_cast<std::size_t>(after - comments.begin());
  std::size_t first = last;
  std::uint32_t below = end;
  const std::string_view text = sources.text(file);
  while (first > 0) {
    const Comment &comment = comments[first - 1];
    if (comment.begin < begin || !comment.startsLine)
      break;
    const std::string_view between = text.substr(comment.end, below - comment.end);
    if (std::count(between.begin(), between.end(), '\n') > 1)
      break; // an empty line
    below = comment.begin;
    --first;
  }
  const auto continues = [&](std::size_t i) {
    const LineColumn above = sources.lineColumn(file, comments[i - 1].begin);
    const LineColumn here = sources.lineColumn(file, comments[i].begin);
    return here.line == above.line + 1 && here.column == above.column;
  };
  if (first > 0 && !comments[first - 1].startsLine)
    while (first < last && continues(first))
      ++first;
  return commentText(first, last);
}

} // namespace rtsl
