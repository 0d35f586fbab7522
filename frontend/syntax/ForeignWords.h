//===- ForeignWords.h - constructs of other languages, before parsing -----===//
//
// Qualifiers, attributes, namespaces, pointers, casts and the like are recognised by their tokens,
// which would only confuse the parser. Each is reported once, with the RTSL equivalent, and removed
// or rewritten, so that the rest can be parsed. Qualifiers that have an equivalent become that, and
// are reported with the declaration, on whose place the right word depends. Only what no RTSL
// program can contain is treated as foreign: `a * b` is a product, whatever `a` is called.
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
  /// Reads `in` from left to right, and may change the tokens not yet read; `out` has the tokens
  /// kept so far.
  ForeignWords(FileId file, std::vector<Token> &in, const std::vector<Token> &out,
               Diagnostics &diagnostics)
      : file(file), in(in), out(out), diagnostics(diagnostics) {}

  /// Number of tokens from `index` on that are reported and removed; 0: none.
  std::size_t skip(std::size_t index);
  /// Number of tokens from `index` on that C combines into one type name, each one space apart.
  /// They become one name, which sema reports as unknown and can replace. 1: not such a name.
  std::size_t wordsOfType(std::size_t index) const;
  /// True if the next token may be the first of a declaration, including that of a parameter.
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
  /// Type of the token that was kept `back` tokens ago.
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
  std::size_t afterBrackets(std::size_t index) const;
  std::size_t afterStatement(std::size_t index) const;
  std::size_t afterOperand(std::size_t index) const;

  const FileId file;
  std::vector<Token> &in;
  const std::vector<Token> &out;
  Diagnostics &diagnostics;
};

} // namespace rtsl
