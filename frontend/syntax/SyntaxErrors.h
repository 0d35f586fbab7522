//===- SyntaxErrors.h - reporting and recovering from syntax errors -------===//
#pragma once

#include "frontend/diagnostics/Diagnostics.h"
#include "frontend/lex/TokenStream.h"

#include <ANTLRErrorStrategy.h>
#include <misc/IntervalSet.h>

namespace rtsl {

/// Reports an error where the parser cannot continue, and finds the position from which it can:
/// after the expression, the statement or the declaration. A rule that cannot recover rethrows the
/// error to the rule that called it, until one of those is reached.
class SyntaxErrors final : public antlr4::ANTLRErrorStrategy {
public:
  SyntaxErrors(FileId file, TokenStream &stream, Diagnostics &diagnostics)
      : file(file), stream(stream), diagnostics(diagnostics) {}

  /// While true, the first error ends the parse with antlr4::ParseCancellationException, and
  /// nothing is reported.
  bool isQuiet = false;

  void reset(antlr4::Parser *) override { isRecovering = false; }
  bool inErrorRecoveryMode(antlr4::Parser *) override { return isRecovering; }
  void reportMatch(antlr4::Parser *) override { isRecovering = false; }

  void reportError(antlr4::Parser *parser, const antlr4::RecognitionException &error) override;
  antlr4::Token *recoverInline(antlr4::Parser *parser) override;
  void sync(antlr4::Parser *parser) override;
  void recover(antlr4::Parser *parser, std::exception_ptr error) override;

private:
  const Token &tokenAt(std::size_t index) const { return stream.at(index)->token; }
  SourceRange rangeOf(std::size_t index) const;
  std::string_view textOf(std::size_t index) const {
    return diagnostics.sources().text(rangeOf(index));
  }
  std::string describe(std::size_t index) const;
  bool isConsequence(std::size_t index) const;
  bool endsBefore(std::size_t index) const;
  bool beginsRange(std::size_t index) const;

  void reportMissingSemicolon(antlr4::Parser *parser, std::size_t index);
  void reportUnexpected(std::size_t index, const std::string &expected);
  void reportInDeclaration(antlr4::Parser *parser, std::size_t start, std::size_t index);
  std::string closingAround(std::size_t index) const;
  std::string expectedToken(antlr4::Parser *parser, std::size_t index) const;

  template <typename EndAt>
  std::size_t findEnd(std::size_t start, std::size_t from, EndAt &&endAt) const;
  std::size_t endOfStatement(std::size_t start, std::size_t from) const;
  std::size_t endOfExpression(std::size_t start, std::size_t from, bool endsAtComma) const;
  std::size_t endOfArguments(std::size_t start, std::size_t from) const;
  std::size_t afterParentheses(std::size_t start, std::size_t from) const;

  const FileId file;
  TokenStream &stream;
  Diagnostics &diagnostics;
  bool isRecovering = false; // after a reported error: what follows may be its consequence
  std::size_t resumeAt = 0;  // the position of that error; the parser may not have reached it
  std::vector<std::unique_ptr<ParserToken>> inserted;
};

} // namespace rtsl
