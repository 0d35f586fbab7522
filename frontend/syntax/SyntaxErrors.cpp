//===- SyntaxErrors.cpp - reporting and recovering from syntax errors -----===//
#include "frontend/syntax/SyntaxErrors.h"

#include "frontend/syntax/ForeignWords.h"

#include "grammar/RtslLexer.h"
#include "grammar/RtslParser.h"

#include <algorithm>
#include <optional>

namespace rtsl {

namespace {

using generated::RtslLexer;
using generated::RtslParser;

constexpr std::size_t maxQuotedBytes = 30;

std::size_t ruleOf(antlr4::Parser *parser) {
  return parser->getContext()->getRuleIndex();
}

std::size_t startOf(antlr4::Parser *parser) {
  return parser->getContext()->start->getTokenIndex();
}

/// Keywords that can only be at the beginning of a statement or declaration.
bool isStatementKeyword(unsigned type) {
  return (type >= RtslLexer::IF && type <= RtslLexer::RETURN && type != RtslLexer::ELSE) ||
         type == RtslLexer::ILLUMINANCE || (type >= RtslLexer::IMPORT && type <= RtslLexer::CONST);
}

/// True for tokens that can end an expression.
bool endsOperand(unsigned type) {
  return type == RtslLexer::IDENTIFIER || isClosing(type) || type == RtslLexer::PLUS_PLUS ||
         type == RtslLexer::MINUS_MINUS || type == RtslLexer::TRUE || type == RtslLexer::FALSE ||
         (type >= RtslLexer::INT_LITERAL && type <= RtslLexer::STRING_LITERAL);
}

} // namespace

//===----------------------------------------------------------------------===//
// Tokens in messages
//===----------------------------------------------------------------------===//

SourceRange SyntaxErrors::rangeOf(std::size_t index) const {
  const Token &token = tokenAt(index);
  if (token.type == Token::endOfFile && index > 0) // after the last token, not after empty lines
    return {file, tokenAt(index - 1).end, tokenAt(index - 1).end};
  return {file, token.begin, token.end};
}

std::string SyntaxErrors::describe(std::size_t index) const {
  if (tokenAt(index).type == Token::endOfFile)
    return "the end of the file";
  const std::string_view text = textOf(index);
  return text.size() > maxQuotedBytes ? fmt::format("`{}...`", text.substr(0, maxQuotedBytes))
                                      : fmt::format("`{}`", text);
}

/// True if an error at this token is a consequence of one that was reported before parsing.
bool SyntaxErrors::isConsequence(std::size_t index) const {
  const Token &token = tokenAt(index);
  if (token.followsMistake || token.isBroken)
    return true;
  // A string without an end may have swallowed anything.
  return index > 0 && tokenAt(index - 1).isBroken &&
         tokenAt(index - 1).type == RtslLexer::STRING_LITERAL;
}

/// True if a statement without its semicolon ends before this token.
bool SyntaxErrors::endsBefore(std::size_t index) const {
  const Token &token = tokenAt(index);
  return token.startsLine || token.type == RtslLexer::RIGHT_BRACE ||
         token.type == Token::endOfFile || (isStatementKeyword(token.type) && !beginsRange(index));
}

/// True if this token is the `in` of a range.
bool SyntaxErrors::beginsRange(std::size_t index) const {
  const unsigned next = tokenAt(index + 1).type;
  return tokenAt(index).type == RtslLexer::IN &&
         (next == RtslLexer::LEFT_BRACKET || next == RtslLexer::LEFT_PAREN);
}

//===----------------------------------------------------------------------===//
// Messages
//===----------------------------------------------------------------------===//

void SyntaxErrors::reportUnexpected(std::size_t index, const std::string &expected) {
  Diagnostic &diagnostic =
      diagnostics.report(Code::unexpectedToken, rangeOf(index), expected, describe(index));
  const auto type = [&](std::size_t back) {
    return index >= back ? tokenAt(index - back).type : Token::endOfFile;
  };
  // Habits from C.
  const bool followsName = type(1) == RtslLexer::IDENTIFIER && type(2) == RtslLexer::IDENTIFIER;
  if (type(0) == RtslLexer::ELSE)
    diagnostic.note("there is no `if` that it could belong to");
  else if (type(0) == RtslLexer::STRUCT && type(1) != RtslLexer::DEFAULT)
    diagnostic.note("a struct cannot be declared in a function");
  else if (type(1) == RtslLexer::IF || type(1) == RtslLexer::WHILE || type(1) == RtslLexer::SWITCH)
    diagnostic.note("a condition is written in parentheses");
  else if (textOf(index) == "extends" || textOf(index) == "implements")
    diagnostic.fix(rangeOf(index), ":", true);
  else if (beginsRange(index))
    diagnostic.note("a range is written before the default: `float roughness in [0, 1] = 0.2`");
  else if (type(0) == RtslLexer::LEFT_PAREN && followsName)
    diagnostic.note(
        "a variable gets its value from `=`; a function cannot be declared in another one");
  else if (type(0) == RtslLexer::LEFT_BRACE && followsName && expected == "`;`")
    diagnostic.note(
        fmt::format("a variable gets its value from `=`, a function has parentheses: `{}()`",
                    textOf(index - 1)));
  else if (type(0) == RtslLexer::COLON && followsName && type(3) == RtslLexer::LEFT_PAREN &&
           type(4) == RtslLexer::FOR)
    diagnostic.note("write a loop with an index: `for (int i = 0; i < array.length(); ++i)`");
}

void SyntaxErrors::reportMissingSemicolon(antlr4::Parser *parser, std::size_t index) {
  const Token &previous = tokenAt(index > 0 ? index - 1 : 0);
  std::string after = fmt::format("`{}`", textOf(index > 0 ? index - 1 : 0));
  if (previous.end == previous.begin || previous.end - previous.begin > maxQuotedBytes)
    after = "this";
  if (previous.type == RtslLexer::RIGHT_BRACE) {
    const auto named = [&](const char *what, antlr4::tree::TerminalNode *name) {
      if (name)
        after = fmt::format("{} `{}`", what, textOf(name->getSymbol()->getTokenIndex()));
    };
    antlr4::ParserRuleContext *context = parser->getContext();
    if (auto *declared = dynamic_cast<RtslParser::ClassDeclarationContext *>(context))
      named("class", declared->IDENTIFIER(0));
    if (auto *declared = dynamic_cast<RtslParser::StructDeclarationContext *>(context))
      named("struct", declared->IDENTIFIER());
  }
  const SourceRange place{file, previous.end, previous.end};
  diagnostics.report(Code::missingSemicolon, place, after).fix(place, ";", true);
}

/// The tokens that may follow an operand inside the brackets around this token.
std::string SyntaxErrors::closingAround(std::size_t index) const {
  std::size_t open = index;
  while (open > 0 && tokenAt(open).depth >= tokenAt(index).depth)
    --open;
  return tokenAt(open).type == RtslLexer::LEFT_BRACKET ? "`]`"
         : tokenAt(open).type == RtslLexer::LEFT_PAREN ? "`,` or `)`"
                                                       : "`;`";
}

/// What a declaration lacks after its type: it has read the tokens from `start` on, up to the one
/// at `index`.
void SyntaxErrors::reportInDeclaration(antlr4::Parser *parser, std::size_t start,
                                       std::size_t index) {
  if (index > start) { // it has a type and a name
    if (endsBefore(index))
      reportMissingSemicolon(parser, index);
    else
      reportUnexpected(index, "`;`");
  } else if (tokenAt(index).type == RtslLexer::LEFT_PAREN && index > 0 &&
             tokenAt(index - 1).type == RtslLexer::IDENTIFIER) {
    const SourceRange name = rangeOf(index - 1);
    Diagnostic &diagnostic = diagnostics.report(Code::missingReturnType, name, textOf(index - 1));
    if (textOf(index - 1) == "rtDeclareVariable")
      diagnostic.note("what a scene sets is a member: `public float roughness;`");
    else
      diagnostic.fix({file, name.begin, name.begin}, "void ", textOf(index - 1) == "constructor");
  } else {
    reportUnexpected(index, "a name");
  }
}

/// The single token that the parser expects next, as a message names it.
std::string SyntaxErrors::expectedToken(antlr4::Parser *parser, std::size_t index) const {
  const antlr4::atn::ATN &atn = parser->getATN();
  const antlr4::misc::IntervalSet &expected = atn.nextTokens(atn.states[parser->getState()]);
  const std::size_t rule = ruleOf(parser);
  if (expected.contains(std::size_t{RtslLexer::IDENTIFIER}))
    return rule == RtslParser::RuleTypeName     ? "a type"
           : rule == RtslParser::RuleModulePath ? "the name of a module"
                                                : "a name";
  if (rule == RtslParser::RuleRange && !expected.contains(std::size_t{RtslLexer::COMMA}))
    return expected.contains(std::size_t{RtslLexer::LEFT_PAREN}) ? "`[` or `(`" : "`]` or `)`";
  if (expected.contains(std::size_t{RtslLexer::RIGHT_PAREN})) {
    if (index > 0 && !endsOperand(tokenAt(index - 1).type))
      return rule == RtslParser::RuleParameters ? "a parameter" : "an expression";
    return rule == RtslParser::RuleCondition || rule == RtslParser::RuleForStatement ? "`)`"
                                                                                     : "`,` or `)`";
  }
  if (rule == RtslParser::RuleInitializer && expected.contains(std::size_t{RtslLexer::RIGHT_BRACE}))
    return "`,` or `}`";
  if (rule == RtslParser::RuleClassDeclaration && expected.contains(std::size_t{RtslLexer::COLON}))
    return "`:` and the class that it derives from";
  // Literal token names are quoted, as in 'while'.
  std::string name = expected.isEmpty() ? std::string()
                                        : parser->getVocabulary().getLiteralName(
                                              static_cast<std::size_t>(expected.getMinElement()));
  if (name.size() < 2)
    return "something else";
  return fmt::format("`{}`", name.substr(1, name.size() - 2));
}

void SyntaxErrors::reportError(antlr4::Parser *parser, const antlr4::RecognitionException &error) {
  if (isQuiet)
    throw antlr4::ParseCancellationException();
  if (isRecovering)
    return;
  isRecovering = true;
  const std::size_t index = error.getOffendingToken()->getTokenIndex();
  resumeAt = index;
  if (isConsequence(index))
    return;

  const auto *noAlternative = dynamic_cast<const antlr4::NoViableAltException *>(&error);
  if (!noAlternative) {
    reportUnexpected(index, expectedToken(parser, index));
    return;
  }
  const std::size_t start = noAlternative->getStartToken()->getTokenIndex();
  switch (ruleOf(parser)) {
  case RtslParser::RuleDeclaration:
    reportInDeclaration(parser, start, index);
    return;
  case RtslParser::RuleFunctionBody: {
    // The tokens before it are the name and the parameters, whose brackets balance.
    std::size_t open = index - 1;
    while (open > 0 && (tokenAt(open).type != RtslLexer::LEFT_PAREN ||
                        tokenAt(open).depth != tokenAt(index - 1).depth))
      --open;
    const bool isMissing =
        tokenAt(index).startsLine || tokenAt(index).type == RtslLexer::RIGHT_BRACE;
    if (isMissing && open > 0)
      diagnostics.report(Code::missingFunctionBody, rangeOf(open - 1), textOf(open - 1));
    else
      reportUnexpected(index, "`{`");
    return;
  }
  case RtslParser::RuleSimpleStatement:
    // The parser has looked ahead, perhaps into brackets, but not consumed anything yet.
    if (index == start || !endsOperand(tokenAt(index - 1).type))
      reportUnexpected(index, "an expression");
    else if (tokenAt(index).depth > tokenAt(start).depth ||
             (isClosing(tokenAt(index).type) && tokenAt(index).type != RtslLexer::RIGHT_BRACE))
      reportUnexpected(index, closingAround(index));
    else if (endsBefore(index))
      reportMissingSemicolon(parser, index);
    else
      reportUnexpected(index, "`;`");
    return;
  case RtslParser::RuleInitializer:
    reportUnexpected(index, endsOperand(tokenAt(index - 1).type) ? "`,` or `}`" : "an expression");
    return;
  case RtslParser::RuleStatement:
    reportUnexpected(index, "a statement");
    return;
  case RtslParser::RuleImportDeclaration:
    reportUnexpected(index, "a module or a file in quotes");
    return;
  case RtslParser::RuleFileItem:
    reportUnexpected(index, "a declaration");
    return;
  case RtslParser::RuleParameter:
    reportUnexpected(index, "a parameter");
    return;
  default:
    reportUnexpected(index, "an expression");
  }
}

//===----------------------------------------------------------------------===//
// Recovery
//===----------------------------------------------------------------------===//

/// The first index from `from` on for which `endAt(index)` gives an index; that index. Tokens in
/// brackets that open after `start` are skipped, and the brackets around `start` are not left.
template <typename EndAt>
std::size_t SyntaxErrors::findEnd(std::size_t start, std::size_t from, EndAt &&endAt) const {
  const unsigned depth = tokenAt(start).depth;
  for (std::size_t index = from;; ++index) {
    const Token &token = tokenAt(index);
    if (token.type == Token::endOfFile)
      return index;
    if (token.depth > depth)
      continue;
    if (isClosing(token.type) && (token.depth < depth || index == start))
      return index;
    if (const std::optional<std::size_t> end = endAt(index))
      return *end;
  }
}

/// Index of the token at which the next statement or declaration begins, after an error at `from`
/// in the one that begins at `start`. Never leaves the brackets around it, and is after `start` if
/// possible.
std::size_t SyntaxErrors::endOfStatement(std::size_t start, std::size_t from) const {
  return findEnd(start, from, [&](std::size_t index) -> std::optional<std::size_t> {
    const Token &token = tokenAt(index);
    if (token.type == RtslLexer::SEMICOLON && tokenAt(index + 1).type != RtslLexer::ELSE)
      return index + 1;
    if (token.type == RtslLexer::RIGHT_BRACE && index > start) { // a block of the broken statement
      const Token &next = tokenAt(index + 1);
      if (next.type == RtslLexer::SEMICOLON)
        return index + 2;
      if (next.type != RtslLexer::ELSE)
        return index + 1;
    }
    if (index == start || !token.startsLine)
      return std::nullopt;
    const unsigned next = tokenAt(index + 1).type;
    if (isStatementKeyword(token.type) ||
        (token.type == RtslLexer::IDENTIFIER &&
         (next == RtslLexer::IDENTIFIER || next == RtslLexer::ASSIGN)))
      return index;
    return std::nullopt;
  });
}

/// Index of the token after an expression: a semicolon, a separating comma, or the closing bracket
/// around it.
std::size_t SyntaxErrors::endOfExpression(std::size_t start, std::size_t from,
                                          bool endsAtComma) const {
  return findEnd(start, from, [&](std::size_t index) -> std::optional<std::size_t> {
    const Token &token = tokenAt(index);
    if (token.type == RtslLexer::SEMICOLON || (endsAtComma && token.type == RtslLexer::COMMA))
      return index;
    if (index > start && token.startsLine && isStatementKeyword(token.type))
      return index;
    return std::nullopt;
  });
}

/// Index of the closing parenthesis of the arguments that begin at `start`.
std::size_t SyntaxErrors::endOfArguments(std::size_t start, std::size_t from) const {
  const unsigned depth = tokenAt(start).depth;
  std::size_t index = from;
  while (tokenAt(index).type != Token::endOfFile && tokenAt(index).depth >= depth &&
         !(index == start && isClosing(tokenAt(index).type)))
    ++index;
  return index;
}

/// Index of the token after a pair of parentheses that opens at `start`.
std::size_t SyntaxErrors::afterParentheses(std::size_t start, std::size_t from) const {
  if (tokenAt(start).type != RtslLexer::LEFT_PAREN)
    return from;
  std::size_t index = std::max(from, start + 1);
  while (tokenAt(index).type != Token::endOfFile && tokenAt(index).depth > tokenAt(start).depth)
    ++index;
  return index + 1;
}

antlr4::Token *SyntaxErrors::recoverInline(antlr4::Parser *parser) {
  if (isQuiet)
    throw antlr4::ParseCancellationException();
  const antlr4::atn::ATN &atn = parser->getATN();
  const std::size_t index = stream.index();
  const bool needsSemicolon =
      atn.nextTokens(atn.states[parser->getState()]).contains(std::size_t{RtslLexer::SEMICOLON});
  if (!needsSemicolon || !endsBefore(index))
    throw antlr4::InputMismatchException(parser);

  if (!isRecovering && !isConsequence(index))
    reportMissingSemicolon(parser, index);
  Token semicolon;
  semicolon.type = RtslLexer::SEMICOLON;
  semicolon.begin = semicolon.end = index > 0 ? tokenAt(index - 1).end : 0;
  semicolon.depth = tokenAt(index).depth;
  inserted.push_back(std::make_unique<ParserToken>(semicolon, INVALID_INDEX));
  return inserted.back().get();
}

/// Called before each iteration of a loop in the grammar. In the loops over statements and
/// declarations, tokens that can begin none are reported and skipped here, so that the loop
/// continues.
void SyntaxErrors::sync(antlr4::Parser *parser) {
  const std::size_t rule = ruleOf(parser);
  const char *expected = nullptr;
  switch (rule) {
  case RtslParser::RuleBlock:
  case RtslParser::RuleSwitchStatement:
    expected = "a statement";
    break;
  case RtslParser::RuleStructDeclaration:
  case RtslParser::RuleClassDeclaration:
    expected = "a member";
    break;
  case RtslParser::RuleTranslationUnit:
    expected = "a declaration";
    break;
  default:
    return;
  }
  const antlr4::atn::ATN &atn = parser->getATN();
  antlr4::atn::ATNState *state = atn.states[parser->getState()];
  if (state->getStateType() != antlr4::atn::ATNState::STAR_LOOP_ENTRY &&
      state->getStateType() != antlr4::atn::ATNState::STAR_LOOP_BACK)
    return;
  const antlr4::misc::IntervalSet &next = atn.nextTokens(state);
  while (!next.contains(stream.LA(1))) {
    if (isQuiet)
      throw antlr4::ParseCancellationException();
    const std::size_t index = stream.index();
    if (!isConsequence(index))
      reportUnexpected(index, expected);
    const std::size_t end = std::max(endOfStatement(index, index), index + 1);
    if (tokenAt(index).type == Token::endOfFile)
      return;
    stream.seek(end);
  }
}

void SyntaxErrors::recover(antlr4::Parser *parser, std::exception_ptr error) {
  const std::size_t start = startOf(parser);
  const std::size_t from = std::max({stream.index(), resumeAt, start});
  switch (ruleOf(parser)) {
  case RtslParser::RuleExpression:
    stream.seek(endOfExpression(start, from, false));
    break;
  case RtslParser::RuleInitializer:
  case RtslParser::RuleParameter:
    stream.seek(endOfExpression(start, from, true));
    break;
  case RtslParser::RuleArguments:
    stream.seek(endOfArguments(start, from));
    break;
  case RtslParser::RuleParameters:
  case RtslParser::RuleCondition:
    if (tokenAt(start).type != RtslLexer::LEFT_PAREN)
      std::rethrow_exception(error);
    stream.seek(afterParentheses(start, from));
    break;
  case RtslParser::RuleFunctionBody:
    if (!tokenAt(from).startsLine && !isClosing(tokenAt(from).type))
      stream.seek(endOfStatement(start, from));
    isRecovering = false;
    break;
  case RtslParser::RuleStatement:
  case RtslParser::RuleDeclaration:
  case RtslParser::RuleImportDeclaration:
  case RtslParser::RuleStructDeclaration:
  case RtslParser::RuleClassDeclaration:
  case RtslParser::RuleFileItem: {
    // A new line after the error that begins like a statement is not part of the broken one.
    const Token &at = tokenAt(from);
    const bool isNext = from > start && at.startsLine && at.depth == tokenAt(start).depth &&
                        (isStatementKeyword(at.type) || at.type == RtslLexer::IDENTIFIER);
    stream.seek(isNext ? from : endOfStatement(start, from));
    isRecovering = false;
    break;
  }
  default:
    std::rethrow_exception(error);
  }
  resumeAt = 0;
}

} // namespace rtsl
