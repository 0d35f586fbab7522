//===- Utf8.cpp - reading UTF-8 and showing it in a terminal --------------===//
#include "frontend/source/Utf8.h"

#include <algorithm>
#include <iterator>

namespace rtsl {

Utf8Character decodeUtf8(std::string_view text) {
  const auto byte = [&](std::size_t i) -> unsigned {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u;
  };
  const unsigned first = byte(0);
  if (first < 0x80)
    return {first, 1, true};
  const std::size_t size = first >= 0xC2 && first <= 0xDF   ? 2
                           : first >= 0xE0 && first <= 0xEF ? 3
                           : first >= 0xF0 && first <= 0xF4 ? 4
                                                            : 0;
  if (size == 0)
    return {first, 1, false};
  char32_t codePoint = first & (0xFFu >> (size + 1));
  for (std::size_t i = 1; i < size; ++i) {
    if ((byte(i) & 0xC0) != 0x80)
      return {first, 1, false};
    codePoint = codePoint << 6 | (byte(i) & 0x3F);
  }
  const bool isOverlong = (size == 3 && codePoint < 0x800) || (size == 4 && codePoint < 0x10000);
  const bool isSurrogate = codePoint >= 0xD800 && codePoint <= 0xDFFF;
  if (isOverlong || isSurrogate || codePoint > 0x10FFFF)
    return {first, 1, false};
  return {codePoint, size, true};
}

std::size_t findInvalidUtf8(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    if (static_cast<unsigned char>(text[at]) < 0x80) {
      ++at;
      continue;
    }
    const Utf8Character character = decodeUtf8(text.substr(at, 4));
    if (!character.isValid)
      return at;
    at += character.size;
  }
  return std::string_view::npos;
}

namespace {

struct CodePoints {
  char32_t first, last;
};

template <std::size_t N>
bool contains(const CodePoints (&ranges)[N], char32_t codePoint) {
  return std::any_of(std::begin(ranges), std::end(ranges), [&](const CodePoints &range) {
    return codePoint >= range.first && codePoint <= range.last;
  });
}

} // namespace

bool isUnprintable(char32_t codePoint) {
  static constexpr CodePoints ranges[] = {{0x00, 0x1F},     {0x7F, 0x9F},     {0x200B, 0x200F},
                                          {0x2028, 0x202E}, {0x2060, 0x2069}, {0xFEFF, 0xFEFF}};
  return contains(ranges, codePoint);
}

unsigned cellWidth(char32_t codePoint) {
  static constexpr CodePoints combining[] = {{0x0300, 0x036F}, {0x20D0, 0x20FF}, {0xFE00, 0xFE0F}};
  // The blocks of Unicode's EastAsianWidth.txt that are entirely wide.
  static constexpr CodePoints wide[] = {{0x1100, 0x115F},   {0x2E80, 0x303E},  {0x3041, 0xA4CF},
                                        {0xAC00, 0xD7A3},   {0xF900, 0xFAFF},  {0xFE30, 0xFE6F},
                                        {0xFF00, 0xFF60},   {0xFFE0, 0xFFE6},  {0x1F300, 0x1F64F},
                                        {0x1F900, 0x1F9FF}, {0x20000, 0x3FFFD}};
  if (codePoint < 0x300)
    return 1;
  return contains(combining, codePoint) ? 0 : contains(wide, codePoint) ? 2 : 1;
}

} // namespace rtsl
