#include "runtime/PlyCheck.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <sstream>
#include <vector>

namespace rtsl::runtime {

namespace {

struct Property {
  bool isList = false;
  std::size_t countSize = 0, size = 0; // bytes of a list's count and of a value
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

/// 0 for a type that PLY does not have.
std::size_t sizeOf(const std::string &type) {
  if (type == "char" || type == "uchar" || type == "int8" || type == "uint8")
    return 1;
  if (type == "short" || type == "ushort" || type == "int16" || type == "uint16")
    return 2;
  if (type == "int" || type == "uint" || type == "int32" || type == "uint32" || type == "float" ||
      type == "float32")
    return 4;
  if (type == "double" || type == "float64")
    return 8;
  return 0;
}

std::optional<Header> readHeader(const std::string &bytes) {
  Header header;
  std::size_t position = 0;
  while (position < bytes.size()) {
    std::size_t newline = bytes.find('\n', position);
    if (newline == std::string::npos)
      return std::nullopt;
    std::istringstream line(bytes.substr(position, newline - position));
    position = newline + 1;
    std::string word, type;
    line >> word;
    if (word == "end_header") {
      header.size = position;
      return header;
    }
    if (word == "format") {
      line >> type;
      header.format = type == "ascii"                  ? Format::Ascii
                      : type == "binary_little_endian" ? Format::LittleEndian
                                                       : Format::BigEndian;
    } else if (word == "element") {
      Element element;
      if (!(line >> element.name >> element.count))
        return std::nullopt;
      header.elements.push_back(element);
    } else if (word == "property") {
      Property property;
      line >> type;
      if (type == "list") {
        property.isList = true;
        line >> type;
        property.countSize = sizeOf(type);
        line >> type;
      }
      property.size = sizeOf(type);
      if (header.elements.empty() || property.size == 0 ||
          (property.isList && property.countSize == 0))
        return std::nullopt;
      header.elements.back().properties.push_back(property);
    }
  }
  return std::nullopt;
}

/// Steps over values; false when they run out.
class Body {
public:
  Body(const std::string &bytes, const Header &header)
      : position(bytes.data() + header.size), end(bytes.data() + bytes.size()),
        format(header.format) {}

  bool skip(const Property &property) {
    std::uint64_t count = 1;
    if (property.isList && !readCount(property.countSize, count))
      return false;
    if (format != Format::Ascii) {
      if (count > std::uint64_t(end - position) / property.size)
        return false;
      position += count * property.size;
      return true;
    }
    for (; count > 0; --count)
      if (nextWord().empty())
        return false;
    return true;
  }

private:
  std::string_view nextWord() {
    auto isSpace = [](char c) { return c == ' ' || (c >= '\t' && c <= '\r'); };
    position = std::find_if_not(position, end, isSpace);
    const char *start = position;
    position = std::find_if(position, end, isSpace);
    return {start, std::size_t(position - start)};
  }

  bool readCount(std::size_t size, std::uint64_t &count) {
    count = 0;
    if (format == Format::Ascii) {
      std::string_view word = nextWord();
      return std::from_chars(word.data(), word.data() + word.size(), count).ec == std::errc();
    }
    if (size > std::size_t(end - position))
      return false;
    for (std::size_t i = 0; i < size; ++i) {
      std::size_t from = format == Format::LittleEndian ? size - 1 - i : i;
      count = count << 8 | static_cast<unsigned char>(position[from]);
    }
    position += size;
    return true;
  }

  const char *position, *end;
  Format format;
};

} // namespace

std::string findMissingPlyElements(const std::string &bytes) {
  std::optional<Header> header = readHeader(bytes);
  if (!header)
    return "";
  Body body(bytes, *header);
  for (const Element &element : header->elements) {
    if (element.properties.empty())
      continue;
    for (std::uint64_t i = 0; i < element.count; ++i)
      for (const Property &property : element.properties)
        if (!body.skip(property))
          return fmt::format("ends in element {} of {} of `{}`", i + 1, element.count,
                             element.name);
  }
  return "";
}

} // namespace rtsl::runtime
