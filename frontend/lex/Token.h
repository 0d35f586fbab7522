//===- Token.h - the tokens of a text, as the parser gets them ------------===//
#pragma once

#include <cstdint>
#include <vector>

namespace rtsl {

/// One token. `type` is one of the token types of grammar/RtslLexer.g4, or `endOfFile`.
struct Token {
  static constexpr std::uint16_t endOfFile = 0xFFFF;

  std::uint32_t begin = 0, end = 0; // bytes of the text
  std::uint16_t type = endOfFile;
  std::uint16_t depth = 0;     // open brackets around it; for a bracket, those outside it
  bool startsLine = false;     // the first token of its line
  bool isBroken = false;       // a literal that could not be read
  bool isForeign = false;      // a qualifier of another language, with the type of RTSL's
  bool followsMistake = false; // text before it was rejected: a syntax error here is a consequence
};

/// A comment, for the syntax tree.
struct Comment {
  std::uint32_t begin = 0, end = 0;
  bool startsLine = false;
};

struct TokenList {
  std::vector<Token> tokens; // the last one is the end of the file
  std::vector<Comment> comments;
  /// False after a mistake (an unclosed comment, unbalanced brackets) from which the parser cannot
  /// recover.
  bool isUsable = true;
};

} // namespace rtsl
