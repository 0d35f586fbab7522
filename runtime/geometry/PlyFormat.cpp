#include "runtime/geometry/PlyFormat.h"

#include <sstream>
#include <utility>

namespace rtsl::runtime::ply {

namespace {

/// None for a type that PLY does not have.
Type typeOf(const std::string &name) {
  static constexpr std::pair<const char *, Type> types[] = {
      {"char", Type::Int8},     {"int8", Type::Int8},     {"uchar", Type::UInt8},
      {"uint8", Type::UInt8},   {"short", Type::Int16},   {"int16", Type::Int16},
      {"ushort", Type::UInt16}, {"uint16", Type::UInt16}, {"int", Type::Int32},
      {"int32", Type::Int32},   {"uint", Type::UInt32},   {"uint32", Type::UInt32},
      {"float", Type::Float},   {"float32", Type::Float}, {"double", Type::Double},
      {"float64", Type::Double}};
  for (const auto &[known, type] : types)
    if (name == known)
      return type;
  return Type::None;
}

/// False for a format that PLY does not have.
bool formatOf(const std::string &name, Format &format) {
  static constexpr std::pair<const char *, Format> formats[] = {
      {"ascii", Format::Ascii},
      {"binary_little_endian", Format::LittleEndian},
      {"binary_big_endian", Format::BigEndian}};
  for (const auto &[known, meant] : formats)
    if (name == known) {
      format = meant;
      return true;
    }
  return false;
}

} // namespace

std::optional<Header> readHeader(std::string_view bytes, std::size_t *lines) {
  Header header;
  std::size_t position = 0, count = 0;
  while (position < bytes.size()) {
    if (lines)
      *lines = ++count;
    std::size_t newline = bytes.find('\n', position);
    if (newline == std::string_view::npos)
      return std::nullopt;
    std::istringstream line(std::string(bytes.substr(position, newline - position)));
    position = newline + 1;
    std::string word, type;
    line >> word;
    if (word == "end_header") {
      header.size = position;
      return header;
    }
    if (word == "format") {
      line >> type;
      if (!formatOf(type, header.format))
        return std::nullopt;
    } else if (word == "element") {
      Element element;
      // A negative number would be read as a large one.
      if (!(line >> element.name >> std::ws) || line.peek() == '-' || !(line >> element.count))
        return std::nullopt;
      header.elements.push_back(element);
    } else if (word == "property") {
      Property property;
      line >> type;
      if (type == "list") {
        property.isList = true;
        line >> type;
        property.countType = typeOf(type);
        line >> type;
      }
      property.type = typeOf(type);
      line >> property.name;
      if (header.elements.empty() || property.type == Type::None ||
          (property.isList && (property.countType == Type::None || isFloating(property.countType))))
        return std::nullopt;
      header.elements.back().properties.push_back(property);
    } else if (!word.empty() && word != "ply" && word != "comment" && word != "obj_info") {
      return std::nullopt;
    }
  }
  return std::nullopt;
}

} // namespace rtsl::runtime::ply
