//===- ByteOrderMark.h - how some programs begin a file in UTF-8 ----------===//
#pragma once

#include <cstddef>
#include <string_view>

namespace rtsl {

/// The number of bytes of the mark at the beginning of a text: 0 if it has none.
inline std::size_t byteOrderMarkLength(std::string_view text) {
  constexpr std::string_view mark = "\xEF\xBB\xBF";
  return text.substr(0, mark.size()) == mark ? mark.size() : 0;
}

} // namespace rtsl
