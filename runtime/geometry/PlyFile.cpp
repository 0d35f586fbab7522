#include "runtime/geometry/PlyFile.h"

#include "runtime/geometry/Normals.h"
#include "runtime/geometry/PolygonSplit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <utility>
#include <vector>

namespace rtsl::runtime {

namespace {

//===----------------------------------------------------------------------===//
// Header
//===----------------------------------------------------------------------===//

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

std::size_t sizeOf(Type type) {
  static constexpr std::uint8_t sizes[] = {0, 1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[std::size_t(type)];
}

bool isFloating(Type type) {
  return type == Type::Float || type == Type::Double;
}

std::optional<Header> readHeader(std::string_view bytes) {
  Header header;
  std::size_t position = 0;
  while (position < bytes.size()) {
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
        property.countType = typeOf(type);
        line >> type;
      }
      property.type = typeOf(type);
      line >> property.name;
      if (header.elements.empty() || property.type == Type::None ||
          (property.isList && (property.countType == Type::None || isFloating(property.countType))))
        return std::nullopt;
      header.elements.back().properties.push_back(property);
    }
  }
  return std::nullopt;
}

//===----------------------------------------------------------------------===//
// Values
//===----------------------------------------------------------------------===//

/// Steps over values. Functions return false at the end of the data, or if a value is not valid.
class Body {
public:
  Body(std::string_view bytes, const Header &header)
      : position(bytes.data() + header.size), end(bytes.data() + bytes.size()),
        format(header.format) {}

  std::size_t bytesLeft() const { return std::size_t(end - position); }

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

  /// A non-negative integer.
  bool readCount(Type type, std::uint64_t &count) {
    if (format == Format::Ascii)
      return readWord(count);
    return !isFloating(type) && readBits(sizeOf(type), count) && !isNegative(type, count);
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
    return {start, std::size_t(position - start)};
  }

  template <typename Number>
  bool readWord(Number &number) {
    const std::string_view word = nextWord();
    const char *last = word.data() + word.size();
    const auto [after, error] = std::from_chars(word.data(), last, number);
    return error == std::errc() && after == last;
  }

  bool readBits(std::size_t size, std::uint64_t &bits) {
    if (size > bytesLeft())
      return false;
    bits = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t from = format == Format::LittleEndian ? size - 1 - i : i;
      bits = bits << 8 | static_cast<unsigned char>(position[from]);
    }
    position += size;
    return true;
  }

  static bool isNegative(Type type, std::uint64_t bits) {
    const bool isSigned = type == Type::Int8 || type == Type::Int16 || type == Type::Int32;
    return isSigned && bits >> (8 * sizeOf(type) - 1) != 0;
  }

  const char *position, *end;
  Format format;
};

//===----------------------------------------------------------------------===//
// Meshes
//===----------------------------------------------------------------------===//

/// The destination of a property of a vertex.
struct Target {
  std::vector<float> *to = nullptr; // null: the column is skipped
  std::size_t component = 0;
};

class Reader {
public:
  Reader(std::string_view bytes, const Header &header) : body(bytes, header), header(header) {}

  bool readAll() {
    for (const Element &element : header.elements) {
      const bool isRead = element.name == "vertex" ? readVertices(element)
                          : element.name == "face" ? readFaces(element)
                                                   : skipElement(element);
      if (!isRead)
        return false;
    }
    return !mesh.indices.empty();
  }

  Mesh mesh;

private:
  Target targetOf(const std::string &name) {
    static constexpr const char *positions[] = {"x", "y", "z"}, *normals[] = {"nx", "ny", "nz"};
    static constexpr const char *us[] = {"u", "s", "texture_u"}, *vs[] = {"v", "t", "texture_v"};
    auto indexIn = [&](const auto &names) {
      return std::size_t(std::find(std::begin(names), std::end(names), name) - std::begin(names));
    };
    if (const std::size_t axis = indexIn(positions); axis < 3)
      return {&mesh.positions, axis};
    if (const std::size_t axis = indexIn(normals); axis < 3)
      return {&mesh.normals, axis};
    if (indexIn(us) < 3)
      return {&mesh.uvs, 0};
    if (indexIn(vs) < 3)
      return {&mesh.uvs, 1};
    return {};
  }

  bool readVertices(const Element &element) {
    if (!mesh.positions.empty() || element.properties.empty() || element.count > body.bytesLeft())
      return false;
    std::vector<Target> targets;
    unsigned components[3] = {}; // of positions, normals and texture coordinates, as bits
    for (const Property &property : element.properties) {
      if (property.isList)
        return false;
      const Target target = targets.emplace_back(targetOf(property.name));
      if (target.to && !isFloating(property.type))
        return false;
      if (!target.to)
        continue;
      unsigned &seen = components[target.to == &mesh.positions ? 0
                                  : target.to == &mesh.normals ? 1
                                                               : 2];
      const unsigned bit = 1u << target.component;
      if (seen & bit)
        return false;
      seen |= bit;
    }
    const auto [positions, normals, uvs] = components;
    if (positions != 7 || (normals != 0 && normals != 7) || (uvs != 0 && uvs != 3))
      return false;
    mesh.positions.resize(3 * element.count);
    mesh.normals.resize(normals ? 3 * element.count : 0);
    mesh.uvs.resize(uvs ? 2 * element.count : 0);
    for (std::size_t i = 0; i < element.count; ++i)
      for (std::size_t p = 0; p < targets.size(); ++p) {
        const Property &property = element.properties[p];
        const auto [to, component] = targets[p];
        const bool isRead =
            to ? body.readFloat(property.type, (*to)[(to == &mesh.uvs ? 2 : 3) * i + component])
               : body.skip(property);
        if (!isRead)
          return false;
      }
    return true;
  }

  bool readFaces(const Element &element) {
    if (mesh.positions.empty())
      return false;
    auto isCorners = [](const Property &property) {
      return property.isList &&
             (property.name == "vertex_indices" || property.name == "vertex_index");
    };
    const auto lists = std::count_if(element.properties.begin(), element.properties.end(),
                                     [](const Property &property) { return property.isList; });
    if (lists != 1 || std::none_of(element.properties.begin(), element.properties.end(), isCorners))
      return false;
    for (std::uint64_t i = 0; i < element.count; ++i)
      for (const Property &property : element.properties)
        if (!(isCorners(property) ? readFace(property) : body.skip(property)))
          return false;
    return true;
  }

  bool readFace(const Property &property) {
    std::uint64_t count;
    if (!body.readCount(property.countType, count) || count < 3 || count > 4)
      return false;
    std::array<std::uint64_t, 4> corners{};
    for (std::size_t i = 0; i < count; ++i)
      if (!body.readCount(property.type, corners[i]) || corners[i] >= mesh.vertexCount())
        return false;
    auto position = [&](int corner) { return &mesh.positions[3 * corners[std::size_t(corner)]]; };
    const std::size_t first =
        count == 3
            ? 0
            : std::size_t(cornerOfDiagonal({position(0), position(1), position(2), position(3)}));
    for (std::size_t i = 1; i + 1 < count; ++i)
      for (std::size_t corner : {first, first + i, first + i + 1})
        mesh.indices.push_back(std::uint32_t(corners[corner % count]));
    return true;
  }

  bool skipElement(const Element &element) {
    if (element.name == "tristrips") // which contain faces, too
      return false;
    if (element.properties.empty())
      return true;
    for (std::uint64_t i = 0; i < element.count; ++i)
      for (const Property &property : element.properties)
        if (!body.skip(property))
          return false;
    return true;
  }

  Body body;
  const Header &header;
};

} // namespace

std::optional<Mesh> readPlainPly(std::string_view bytes) {
  if (bytes.substr(0, 4) != "ply\n" && bytes.substr(0, 5) != "ply\r\n")
    return std::nullopt;
  const std::optional<Header> header = readHeader(bytes);
  if (!header)
    return std::nullopt;
  Reader reader(bytes, *header);
  if (!reader.readAll())
    return std::nullopt;
  normalize(reader.mesh.normals);
  return std::move(reader.mesh);
}

std::string findMissingPlyElements(std::string_view bytes) {
  const std::optional<Header> header = readHeader(bytes);
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
