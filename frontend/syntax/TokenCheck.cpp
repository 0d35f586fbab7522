//===- TokenCheck.cpp - checks on the tokens, before parsing --------------===//
//
// The parser recurses for nested constructs, and a missing bracket makes the rest of the text
// unintelligible. Both are handled here, in one pass over the tokens, so that the parser always
// gets balanced brackets and never overflows the stack.
//
// The depth of the tree is bounded from above without building it: a chain of operators (or of
// `if`, `for`, ... ) is as deep as it is long, plus the deepest bracket in it.
//
//===----------------------------------------------------------------------===//
#include "frontend/syntax/TokenCheck.h"

#include "frontend/syntax/ForeignWords.h"

#include "grammar/RtslLexer.h"

#include <algorithm>

namespace rtsl {

namespace {

using generated::RtslLexer;

unsigned closingOf(unsigned opening) {
  return opening == RtslLexer::LEFT_PAREN     ? RtslLexer::RIGHT_PAREN
         : opening == RtslLexer::LEFT_BRACKET ? RtslLexer::RIGHT_BRACKET
                                              : RtslLexer::RIGHT_BRACE;
}

std::string_view spellingOf(unsigned bracket) {
  switch (bracket) {
  case RtslLexer::LEFT_PAREN:
    return "(";
  case RtslLexer::RIGHT_PAREN:
    return ")";
  case RtslLexer::LEFT_BRACKET:
    return "[";
  case RtslLexer::RIGHT_BRACKET:
    return "]";
  case RtslLexer::LEFT_BRACE:
    return "{";
  default:
    return "}";
  }
}

bool isKeyword(unsigned type) {
  return type >= RtslLexer::IMPORT && type <= RtslLexer::FALSE;
}

bool isOperator(unsigned type) {
  return (type >= RtslLexer::PLUS_PLUS && type <= RtslLexer::OR_ASSIGN) || type == RtslLexer::DOT;
}

/// Statements that end with a nested statement.
bool isPrefixStatement(unsigned type) {
  return type == RtslLexer::IF || type == RtslLexer::FOR || type == RtslLexer::WHILE ||
         type == RtslLexer::DO || type == RtslLexer::SWITCH || type == RtslLexer::ILLUMINANCE;
}

class TokenChecker {
public:
  TokenChecker(FileId file, TokenList &list, Diagnostics &diagnostics)
      : file(file), diagnostics(diagnostics), sources(diagnostics.sources()), list(list),
        in(list.tokens), foreign(file, in, out, diagnostics) {}

  void run();

private:
  /// The tokens between two brackets, or outside of all.
  struct Level {
    enum Kind { Block, InitializerList, Group, Arguments, ForHeader, Index, Range };
    Kind kind = Block;
    Token open; // end of file: the outermost level
    // The current chain: since the last separator.
    unsigned operators = 0, statements = 0;
    unsigned inner = 0;            // height of the highest bracket in it
    unsigned pendingQuestions = 0; // `?` without their `:`
    unsigned height = 0;           // of the highest chain so far
    unsigned semicolons = 0;

    unsigned chain() const { return operators + statements + inner; }
    void endChain() {
      height = std::max(height, chain());
      operators = statements = inner = pendingQuestions = 0;
    }
    bool isBlock() const { return kind == Block || kind == InitializerList; }
  };

  const Token &at(std::size_t index) const { return in[std::min(index, in.size() - 1)]; }
  unsigned typeAt(std::size_t index) const { return at(index).type; }
  /// Type of the token that was output `back` tokens ago.
  unsigned before(std::size_t back = 1) const {
    return back <= out.size() ? out[out.size() - back].type : unsigned{Token::endOfFile};
  }
  SourceRange rangeOf(const Token &token) const { return {file, token.begin, token.end}; }
  std::string_view textOf(const Token &token) const { return sources.text(rangeOf(token)); }
  std::uint32_t endOfPrevious() const { return out.empty() ? 0 : out.back().end; }

  void retag(Token &token, std::size_t index);

  void put(Token token);
  void breakStatement();
  void open(Token token);
  void close(const Token &token);
  void closeMissing(bool isReported);
  bool isClosedSoon(std::size_t index) const;
  void handleClosing(const Token &token);
  void handleUnclosedAtEnd();
  void closeBefore(Token &token, std::size_t index);
  bool openAfter(unsigned previous, const Token &token);
  void measure(const Token &token, unsigned next);
  bool checkHeight(const Token &token);

  const FileId file;
  Diagnostics &diagnostics;
  const SourceManager &sources;
  TokenList &list;
  std::vector<Token> in, out;
  ForeignWords foreign;
  std::vector<Level> levels{1};
  Token lastOuterClose; // the last brace that closed the outermost block
  bool isStatementBroken = false;
};

//===----------------------------------------------------------------------===//
// Tokens with another meaning in their context
//===----------------------------------------------------------------------===//

/// Turns keywords where a name is required into names, and `illuminance` into a keyword.
void TokenChecker::retag(Token &token, std::size_t index) {
  const unsigned next = typeAt(index + 1);
  if (token.type == RtslLexer::IDENTIFIER) {
    const unsigned previous = before();
    const bool isStatementStart =
        previous == RtslLexer::SEMICOLON || previous == RtslLexer::LEFT_BRACE ||
        previous == RtslLexer::RIGHT_BRACE || previous == RtslLexer::RIGHT_PAREN ||
        previous == RtslLexer::COLON || previous == RtslLexer::ELSE || previous == RtslLexer::DO;
    if (next == RtslLexer::LEFT_PAREN && isStatementStart && textOf(token) == "illuminance")
      token.type = RtslLexer::ILLUMINANCE;
    return;
  }
  if (!isKeyword(token.type) || token.startsLine)
    return;
  const bool followsDeclarator =
      before() == RtslLexer::IDENTIFIER && before(2) == RtslLexer::COMMA && levels.back().isBlock();
  if (token.type == RtslLexer::IN && isOpening(next) && followsDeclarator)
    return; // `float a = 0.5, b in [0, 1];`
  const bool isNamed = before() == RtslLexer::DOT ||
                       (before() == RtslLexer::CLASS && next == RtslLexer::COLON) ||
                       (before() == RtslLexer::STRUCT && next == RtslLexer::LEFT_BRACE);
  bool isDeclared = false;
  if (before() == RtslLexer::IDENTIFIER && out.size() >= 2) {
    const Token type = out.back();
    out.pop_back();
    isDeclared = foreign.isDeclarationStart();
    out.push_back(type);
  } else if (before() == RtslLexer::IDENTIFIER) {
    isDeclared = true;
  }
  const bool isBeforeNameEnd = next == RtslLexer::ASSIGN || next == RtslLexer::SEMICOLON ||
                               next == RtslLexer::COMMA || next == RtslLexer::RIGHT_PAREN ||
                               next == RtslLexer::LEFT_PAREN || next == RtslLexer::LEFT_BRACKET;
  if (!isNamed && !(isDeclared && isBeforeNameEnd))
    return;
  diagnostics.report(Code::keywordAsName, rangeOf(token), textOf(token));
  token.type = RtslLexer::IDENTIFIER;
}

//===----------------------------------------------------------------------===//
// Brackets
//===----------------------------------------------------------------------===//

void TokenChecker::put(Token token) {
  token.depth = static_cast<std::uint16_t>(levels.size() - 1);
  // A bracket error explains later syntax errors in the same statement.
  if (token.type == RtslLexer::SEMICOLON || token.type == RtslLexer::LEFT_BRACE ||
      token.type == RtslLexer::RIGHT_BRACE)
    isStatementBroken = false;
  token.followsMistake |= isStatementBroken;
  out.push_back(token);
}

/// Marks syntax errors in the current statement as consequences of a bracket error.
void TokenChecker::breakStatement() {
  isStatementBroken = true;
  // Bounded: a list of thousands of values need not be searched for each error in it.
  constexpr std::size_t farthest = 500;
  for (std::size_t back = 1; back <= std::min(out.size(), farthest); ++back) {
    Token &token = out[out.size() - back];
    const bool isOutside = token.type == RtslLexer::LEFT_BRACE ||
                           token.type == RtslLexer::RIGHT_BRACE ||
                           (token.type == RtslLexer::SEMICOLON && levels.back().isBlock());
    if (isOutside)
      break;
    token.followsMistake = true;
  }
}

void TokenChecker::open(Token token) {
  Level level;
  level.open = token;
  const unsigned previous = before();
  if (token.type == RtslLexer::LEFT_BRACE)
    level.kind = previous == RtslLexer::ASSIGN || levels.back().kind == Level::InitializerList
                     ? Level::InitializerList
                     : Level::Block;
  else if (previous == RtslLexer::IN)
    level.kind = Level::Range;
  else if (token.type == RtslLexer::LEFT_BRACKET)
    level.kind = Level::Index;
  else if (previous == RtslLexer::FOR)
    level.kind = Level::ForHeader;
  else if (previous == RtslLexer::IDENTIFIER || previous == RtslLexer::ILLUMINANCE ||
           previous == RtslLexer::RIGHT_BRACKET)
    level.kind = Level::Arguments;
  else
    level.kind = Level::Group;
  put(token);
  levels.push_back(level);
}

void TokenChecker::close(const Token &token) {
  levels.back().endChain();
  const unsigned height = levels.back().height + 1;
  levels.pop_back();
  levels.back().inner = std::max(levels.back().inner, height);
  put(token);
  if (levels.size() == 1 && token.type == RtslLexer::RIGHT_BRACE)
    lastOuterClose = token;
}

/// Inserts the closing bracket of the innermost level, directly after the last token.
void TokenChecker::closeMissing(bool isReported) {
  const Token opening = levels.back().open;
  Token closing;
  closing.type = static_cast<std::uint16_t>(closingOf(opening.type));
  closing.begin = closing.end = endOfPrevious();
  if (isReported)
    diagnostics.report(Code::unclosedBracket, rangeOf(opening), textOf(opening))
        .fix({file, closing.begin, closing.begin}, std::string(spellingOf(closing.type)));
  breakStatement();
  close(closing);
}

/// True if the parenthesis around the token at `index` is closed before the next brace.
bool TokenChecker::isClosedSoon(std::size_t index) const {
  int depth = 0;
  for (; index < in.size(); ++index) {
    const unsigned type = typeAt(index);
    if (type == RtslLexer::LEFT_BRACE || type == RtslLexer::RIGHT_BRACE)
      return false;
    depth += (type == RtslLexer::LEFT_PAREN) - (type == RtslLexer::RIGHT_PAREN);
    if (depth < 0)
      return true;
  }
  return false;
}

void TokenChecker::handleClosing(const Token &token) {
  // The brackets of a range say whether its bounds belong to it, and need not be alike.
  const bool closesRange =
      levels.back().kind == Level::Range && token.type != RtslLexer::RIGHT_BRACE;
  if (closesRange || (levels.size() > 1 && token.type == closingOf(levels.back().open.type))) {
    close(token);
    return;
  }
  // Is it the closing bracket of an outer level? Only braces close over other braces.
  std::size_t level = levels.size() - 1;
  while (level > 0 && token.type != closingOf(levels[level].open.type) &&
         (token.type == RtslLexer::RIGHT_BRACE || !levels[level].isBlock()))
    --level;
  if (level > 0 && token.type == closingOf(levels[level].open.type)) {
    const std::size_t missing = levels.size() - 1 - level;
    for (std::size_t i = 0; i < missing; ++i)
      closeMissing(i + 1 == missing); // one message: for the outermost
    Token closing = token;
    closing.followsMistake = true;
    close(closing);
    return;
  }
  if (levels.size() > 1 && !levels.back().isBlock()) { // `f(a]`
    const Token &opening = levels.back().open;
    const std::string_view expected = spellingOf(closingOf(opening.type));
    diagnostics
        .report(Code::unexpectedToken, rangeOf(token), fmt::format("`{}`", expected),
                fmt::format("`{}`", textOf(token)))
        .label(rangeOf(opening), "opened here")
        .fix(rangeOf(token), std::string(expected));
    Token closing = token;
    closing.type = static_cast<std::uint16_t>(closingOf(opening.type));
    close(closing);
    return;
  }
  if (token.type != RtslLexer::RIGHT_BRACE) {
    if (!isStatementBroken)
      diagnostics.report(Code::unmatchedBracket, rangeOf(token), textOf(token));
    breakStatement();
    return;
  }
  Diagnostic &diagnostic =
      diagnostics.report(Code::unmatchedBracket, rangeOf(token), textOf(token));
  if (lastOuterClose.end != 0)
    diagnostic.label(rangeOf(lastOuterClose), "all brackets were closed here");
  // Directly after another closing brace it is just one too many. Elsewhere, an earlier one closed
  // too much, and what is in between makes no sense outside.
  if (before() != RtslLexer::RIGHT_BRACE)
    list.isUsable = false;
}

/// A bracket is still open at the end of the file. The indentation shows which one is not closed:
/// the first one whose closing brace is further to the left.
void TokenChecker::handleUnclosedAtEnd() {
  struct Open {
    Token token;
    std::uint32_t indent;
  };
  std::vector<Open> stack;
  const std::string_view text = sources.text(file);
  std::uint32_t indent = 0;
  list.isUsable = false;
  for (const Token &token : out) {
    if (token.startsLine) {
      const std::size_t newline =
          token.begin == 0 ? std::string_view::npos : text.find_last_not_of(" \t", token.begin - 1);
      indent = newline == std::string_view::npos
                   ? token.begin
                   : token.begin - static_cast<std::uint32_t>(newline) - 1;
    }
    if (isOpening(token.type)) {
      stack.push_back({token, indent});
    } else if (isClosing(token.type) && !stack.empty()) {
      if (token.type == RtslLexer::RIGHT_BRACE && token.startsLine &&
          indent < stack.back().indent) {
        diagnostics.report(Code::unclosedBracket, rangeOf(stack.back().token), "{")
            .label(rangeOf(token), "indented like the end of an outer block");
        return;
      }
      stack.pop_back();
    }
  }
  const Token opening = levels.back().open;
  diagnostics.report(Code::unclosedBracket, rangeOf(opening), textOf(opening));
}

//===----------------------------------------------------------------------===//
// Depth
//===----------------------------------------------------------------------===//

bool TokenChecker::checkHeight(const Token &token) {
  const Level &level = levels.back();
  if (level.chain() <= maxNesting)
    return true;
  const bool isStatement = level.statements > level.operators;
  Diagnostic &diagnostic = diagnostics.report(Code::nestedTooDeep, rangeOf(token),
                                              isStatement ? "statement" : "expression", maxNesting);
  diagnostic.note(isStatement ? "split it into functions"
                              : "split it: assign parts of it to variables");
  list.isUsable = false;
  return false;
}

/// Updates the chains of operators and statements. Brackets are measured where they are opened and
/// closed.
void TokenChecker::measure(const Token &token, unsigned next) {
  Level &level = levels.back();
  const unsigned type = token.type;
  if (isOperator(type)) {
    ++level.operators;
  } else if (type == RtslLexer::QUESTION) {
    ++level.operators;
    ++level.pendingQuestions;
  } else if (type == RtslLexer::COLON) {
    if (level.pendingQuestions > 0)
      --level.pendingQuestions;
    else
      level.endChain(); // a label
  } else if (isPrefixStatement(type)) {
    ++level.statements;
  } else if (type == RtslLexer::COMMA) {
    const bool separates = level.isBlock() || level.kind == Level::Arguments;
    if (separates && level.pendingQuestions == 0)
      level.endChain();
    else
      ++level.operators;
  } else if (type == RtslLexer::SEMICOLON || type == RtslLexer::RIGHT_BRACE) {
    const bool endsStatement = level.kind == Level::Block || level.kind == Level::ForHeader;
    if (endsStatement && next != RtslLexer::ELSE)
      level.endChain();
  }
}

//===----------------------------------------------------------------------===//
// The pass
//===----------------------------------------------------------------------===//

/// Parentheses end at the end of a statement at the latest: closes those that are open before a
/// brace or a semicolon that ends one.
void TokenChecker::closeBefore(Token &token, std::size_t index) {
  const unsigned previous = before();
  const bool isOfFunction = previous == RtslLexer::LEFT_PAREN &&
                            before(2) == RtslLexer::IDENTIFIER &&
                            before(3) == RtslLexer::IDENTIFIER; // `void f( {`
  const bool isList = previous == RtslLexer::ASSIGN || previous == RtslLexer::COMMA ||
                      previous == RtslLexer::LEFT_PAREN;
  const bool opensBlock = token.type == RtslLexer::LEFT_BRACE && !levels.back().isBlock() &&
                          (!isList || isOfFunction || levels.back().kind == Level::Index);
  const auto endsHeader = [&] {
    Level &level = levels.back();
    if (token.type != RtslLexer::SEMICOLON || level.isBlock())
      return false;
    // A superfluous semicolon is left to the parser, as long as the header ends at all.
    return level.kind != Level::ForHeader || (++level.semicolons > 2 && !isClosedSoon(index));
  };
  if (!opensBlock && !endsHeader())
    return;
  // One message for all of them, at the outermost; a `for` whose semicolons are not complete stays
  // open.
  std::size_t missing = 0;
  for (std::size_t i = levels.size() - 1; i > 0 && !levels[i].isBlock(); --i, ++missing)
    if (token.type == RtslLexer::SEMICOLON && levels[i].kind == Level::ForHeader &&
        levels[i].semicolons < 2) {
      ++levels[i].semicolons;
      break;
    }
  token.followsMistake |= missing > 0;
  for (; missing > 0; --missing)
    closeMissing(missing == 1);
}

/// False, with a message, if brackets are nested too deeply. `previous`: the type of the token
/// before it.
bool TokenChecker::openAfter(unsigned previous, const Token &token) {
  if (levels.size() - 1 == maxBracketDepth) {
    diagnostics.report(Code::bracketsTooDeep, rangeOf(token), maxBracketDepth);
    list.isUsable = false;
    return false;
  }
  // A bracket after an operand is an operator: a call or an index.
  if (previous == RtslLexer::IDENTIFIER || previous == RtslLexer::RIGHT_PAREN ||
      previous == RtslLexer::RIGHT_BRACKET)
    levels.back().operators += token.type != RtslLexer::LEFT_BRACE;
  open(token);
  return true;
}

void TokenChecker::run() {
  out.reserve(in.size());
  bool followsMistake = false;
  for (std::size_t index = 0; index < in.size(); ++index) {
    if (const std::size_t count = foreign.skip(index)) {
      index += count - 1;
      if (index + 1 < in.size())
        in[index + 1].startsLine |= in[index + 1 - count].startsLine;
      continue;
    }
    Token token = in[index];
    const std::size_t words = foreign.wordsOfType(index);
    index += words - 1;
    token.end = in[index].end;
    token.followsMistake |= followsMistake;
    followsMistake = false;
    retag(token, index);

    if (token.type == Token::endOfFile) {
      if (levels.size() > 1)
        handleUnclosedAtEnd();
      put(token);
      break;
    }

    const unsigned previous = before();
    closeBefore(token, index);
    if (isOpening(token.type)) {
      if (!openAfter(previous, token))
        break;
    } else if (isClosing(token.type)) {
      const std::size_t size = out.size();
      handleClosing(token);
      followsMistake = out.size() == size; // left out
      if (!followsMistake)
        measure(token, typeAt(index + 1));
    } else {
      put(token);
      measure(token, typeAt(index + 1));
    }
    if (!checkHeight(token))
      break;
  }
  if (out.empty() || out.back().type != Token::endOfFile)
    list.isUsable = false;
  list.tokens = std::move(out);
}

} // namespace

void checkTokens(FileId file, TokenList &list, Diagnostics &diagnostics) {
  TokenChecker(file, list, diagnostics).run();
}

} // namespace rtsl
