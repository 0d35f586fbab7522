//===- ForeignWords.h - habits of other languages, seen before parsing -------===//
//
// Qualifiers, attributes, namespaces, pointers, casts and the like are known at sight, and the
// parser would only stumble over them. Each is reported once, with what RTSL says instead, and left
// out or put right, so that the rest is understood. Only what no program of RTSL can mean is taken
// for foreign: `a * b` is a product, whatever `a` is called.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "frontend/diagnostics/Diagnostics.h"
#include "frontend/lex/Token.h"

#include <algorithm>
#include <string_view>

namespace rtsl {

/// Is the token a bracket of any kind that opens, or closes?
bool isOpening(unsigned type);
bool isClosing(unsigned type);

class ForeignWords {
public:
  /// Reads `in` from left to right, and changes it in front of what was read; `out` has what is
  /// kept so far.
  ForeignWords(FileId file, std::vector<Token> &in, const std::vector<Token> &out,
               Diagnostics &diagnostics)
      : file(file), in(in), out(out), diagnostics(diagnostics) {}

  /// Number of words from `index` on that are reported and left out; 0: none.
  std::size_t skip(std::size_t index);
  /// Number of words from `index` on that C takes for one type and that stand one space apart: one
  /// name, which the checker does not know and can replace. 1: it is none of those.
  std::size_t wordsOfType(std::size_t index) const;
  /// True if what comes next may be the first word of a declaration, of a parameter too.
  bool isDeclarationStart() const;

private:
  std::size_t skipPrecision(std::size_t index);
  std::size_t skipAccess(std::size_t index);
  std::size_t skipQualifier(std::size_t index);
  std::size_t skipConstruct(std::size_t index);
  std::size_t skipNamespace(std::size_t index);
  std::size_t skipPointer(std::size_t index);
  void rewriteOperator(std::size_t index);
  void rewriteCast(std::size_t index);
  bool isBehindType() const;
  bool isCast(std::size_t index) const;

  const Token &at(std::size_t index) const { return in[std::min(index, in.size() - 1)]; }
  unsigned typeAt(std::size_t index) const { return at(index).type; }
  /// Type of the word that was kept `back` words ago.
  unsigned before(std::size_t back = 1) const {
    return back <= out.size() ? out[out.size() - back].type : unsigned{Token::endOfFile};
  }
  SourceRange rangeOf(const Token &token) const { return {file, token.begin, token.end}; }
  std::string_view textOf(const Token &token) const {
    return diagnostics.sources().text(rangeOf(token));
  }
  SourceRange removal(std::size_t index, std::size_t count) const;
  bool isStatementStart() const;
  bool expectsOperand() const;
  bool touches(std::size_t index, unsigned first, unsigned second) const;
  std::size_t behindBrackets(std::size_t index) const;
  std::size_t behindStatement(std::size_t index) const;
  std::size_t behindOperand(std::size_t index) const;

  const FileId file;
  std::vector<Token> &in;
  const std::vector<Token> &out;
  Diagnostics &diagnostics;
};

} // namespace rtsl
