//===- Token.h - the words of a text, as the parser gets them -------------===//
#pragma once

#include <cstdint>
#include <vector>

namespace rtsl {

/// One word. `type` is one of the token types of grammar/RtslLexer.g4, or `endOfFile`.
struct Token {
  static constexpr std::uint16_t endOfFile = 0xFFFF;

  std::uint32_t begin = 0, end = 0; // bytes of the text
  std::uint16_t type = endOfFile;
  std::uint16_t depth = 0; // brackets that are open around it; a bracket stands outside of itself
  bool startsLine = false; // the first word of its line
  bool isBroken = false;   // a literal that could not be read
  bool followsMistake =
      false; // text in front of it was refused: what the parser says here is a consequence
};

/// A comment, for the syntax tree.
struct Comment {
  std::uint32_t begin = 0, end = 0;
  bool startsLine = false;
};

struct TokenList {
  std::vector<Token> tokens; // the last one is the end of the file
  std::vector<Comment> comments;
  /// False after mistakes (an unclosed comment, brackets that do not balance) behind which nothing
  /// can be understood.
  bool isUsable = true;
};

} // namespace rtsl
