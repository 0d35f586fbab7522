//===- PlyFormat.h - header and values of PLY files -----------------------===//
//
// What a PLY file declares, and its values one after the other, in text and in both byte orders.
// PlyFile.h reads meshes by it, and runtime/buffers/PlyColumns.h columns of numbers.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace rtsl::runtime::ply {

enum class Type : std::uint8_t { None, Int8, UInt8, Int16, UInt16, Int32, UInt32, Float, Double };

struct Property {
  std::string name;
  bool isList = false;
  Type countType = Type::None, type = Type::None; // of a list's count, and of a value
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};

enum class Format { Ascii, LittleEndian, BigEndian };

struct Header {
  Format format = Format::Ascii;
  std::vector<Element> elements;
  std::size_t size = 0;
};

inline std::size_t sizeOf(Type type) {
  static constexpr std::uint8_t sizes[] = {0, 1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[std::size_t(type)];
}

inline bool isFloating(Type type) {
  return type == Type::Float || type == Type::Double;
}

/// Is it the first line of a PLY file?
inline bool isPly(std::string_view bytes) {
  return bytes.substr(0, 4) == "ply\n" || bytes.substr(0, 5) == "ply\r\n";
}

/// Nothing if the header is damaged or does not end: `lines` is then the line that is at fault, or
/// how many lines there are, and else that of `end_header`.
std::optional<Header> readHeader(std::string_view bytes, std::size_t *lines = nullptr);

/// Steps over values. Functions return false at the end of the data, or if a value is not valid.
class Body {
public:
  Body(std::string_view bytes, const Header &header)
      : position(bytes.data() + header.size), end(bytes.data() + bytes.size()),
        format(header.format) {}

  std::size_t bytesLeft() const { return std::size_t(end - position); }
  /// In a text file, the last word that was read, which is at fault after a failure; empty at the
  /// end.
  std::string_view lastWord() const { return word; }

  bool skip(const Property &property) {
    std::uint64_t count = 1;
    if (property.isList && !readCount(property.countType, count))
      return false;
    if (format != Format::Ascii) {
      const std::size_t size = sizeOf(property.type);
      if (count > bytesLeft() / size)
        return false;
      position += count * size;
      return true;
    }
    for (; count > 0; --count)
      if (nextWord().empty())
        return false;
    return true;
  }

  /// Skips so many rows of an element, which has properties.
  bool skipRows(const Element &element, std::uint64_t count) {
    const bool hasLists = std::any_of(element.properties.begin(), element.properties.end(),
                                      [](const Property &one) { return one.isList; });
    if (format != Format::Ascii && !hasLists) {
      std::size_t size = 0;
      for (const Property &property : element.properties)
        size += sizeOf(property.type);
      if (count > bytesLeft() / size)
        return false;
      position += count * size;
      return true;
    }
    for (; count > 0; --count)
      for (const Property &property : element.properties)
        if (!skip(property))
          return false;
    return true;
  }

  /// A non-negative integer.
  bool readCount(Type type, std::uint64_t &count) {
    if (format == Format::Ascii)
      return readWord(count);
    return !isFloating(type) && readBits(sizeOf(type), count) && !isNegative(type, count);
  }

  /// A number that the type can hold; a float may be NaN or infinite.
  bool readNumber(Type type, double &number) {
    if (format == Format::Ascii)
      return readWord(number) && (isFloating(type) || isInteger(type, number));
    std::uint64_t bits;
    if (!readBits(sizeOf(type), bits))
      return false;
    if (type == Type::Double) {
      std::memcpy(&number, &bits, sizeof number);
    } else if (type == Type::Float) {
      float single;
      const auto low = std::uint32_t(bits);
      std::memcpy(&single, &low, sizeof single);
      number = double(single);
    } else {
      number = double(bits) - (isNegative(type, bits) ? std::ldexp(1.0, bitsOf(type)) : 0.0);
    }
    return true;
  }

  /// A finite number.
  bool readFloat(Type type, float &number) {
    if (format == Format::Ascii)
      return readWord(number) && std::isfinite(number);
    std::uint64_t bits;
    if (!readBits(sizeOf(type), bits))
      return false;
    if (type == Type::Double) {
      double value;
      std::memcpy(&value, &bits, sizeof value);
      number = float(value);
    } else {
      const auto low = std::uint32_t(bits);
      std::memcpy(&number, &low, sizeof number);
    }
    return std::isfinite(number);
  }

private:
  std::string_view nextWord() {
    auto isSpace = [](char c) { return c == ' ' || (c >= '\t' && c <= '\r'); };
    position = std::find_if_not(position, end, isSpace);
    const char *start = position;
    position = std::find_if(position, end, isSpace);
    return word = {start, std::size_t(position - start)};
  }

  template <typename Number>
  bool readWord(Number &number) {
    nextWord();
    const bool hasPlus = word.size() > 1 && word[0] == '+' && word[1] != '-';
    const char *last = word.data() + word.size();
    const auto [after, error] = std::from_chars(word.data() + hasPlus, last, number);
    return error == std::errc() && after == last;
  }

  bool readBits(std::size_t size, std::uint64_t &bits) {
    if (size > bytesLeft())
      return false;
    bits = size == 1   ? unsigned(static_cast<unsigned char>(*position))
           : size == 2 ? load<std::uint16_t>()
           : size == 4 ? load<std::uint32_t>()
                       : load<std::uint64_t>();
    position += size;
    return true;
  }

  template <typename Bits>
  Bits load() const {
    char bytes[sizeof(Bits)];
    std::memcpy(bytes, position, sizeof bytes);
    if (format == Format::BigEndian)
      std::reverse(bytes, bytes + sizeof bytes);
    Bits bits;
    std::memcpy(&bits, bytes, sizeof bits);
    return bits;
  }

  static int bitsOf(Type type) { return 8 * int(sizeOf(type)); }

  static bool isSigned(Type type) {
    return type == Type::Int8 || type == Type::Int16 || type == Type::Int32;
  }

  static bool isNegative(Type type, std::uint64_t bits) {
    return isSigned(type) && bits >> (bitsOf(type) - 1) != 0;
  }

  /// Is it one of those of the type?
  static bool isInteger(Type type, double number) {
    const int bits = bitsOf(type) - isSigned(type);
    const double lowest = isSigned(type) ? -std::ldexp(1.0, bits) : 0.0;
    return number >= lowest && number < std::ldexp(1.0, bits) && number == std::floor(number);
  }

  const char *position, *end;
  Format format;
  std::string_view word;
};

} // namespace rtsl::runtime::ply
