//===- Utf8.h - reading UTF-8 and showing it in a terminal ----------------===//
#pragma once

#include <cstdint>
#include <string_view>

namespace rtsl {

/// The character at the start of a text.
struct Utf8Character {
  char32_t codePoint = 0;
  std::size_t size = 1; // bytes; 1 if not valid
  bool isValid = false;
};

/// Decodes the first character of a text that is not empty. Overlong forms, surrogates and values
/// above U+10FFFF are not valid (Unicode 15, table 3-7).
Utf8Character decodeUtf8(std::string_view text);

/// Offset of the first byte that is not part of valid UTF-8, or npos.
std::size_t findInvalidUtf8(std::string_view text);

/// Control characters, and those that reorder the text around them: a message never sends these to
/// a terminal.
bool isUnprintable(char32_t codePoint);

/// Cells of a terminal that a character fills: 0 for combining marks, 2 for East Asian wide ones,
/// else 1.
unsigned cellWidth(char32_t codePoint);

} // namespace rtsl
