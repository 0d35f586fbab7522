#include "runtime/geometry/PlyFile.h"

#include "runtime/geometry/Normals.h"
#include "runtime/geometry/PlyFormat.h"
#include "runtime/geometry/PolygonSplit.h"
#include "support/ErrorMessages.h"
#include "support/LargeArray.h"
#include "support/Parallel.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

namespace rtsl::runtime {

using namespace ply;

namespace {

/// The destination of a property of a vertex.
struct Target {
  std::vector<float> *to = nullptr; // null: the column is skipped
  std::size_t component = 0;
};

/// Rows of an element that are read at once.
struct Rows {
  Body body; // at the first
  std::size_t first, end;
  std::size_t firstTriangle; // of faces
};
constexpr std::size_t rowsAtOnce = 1 << 15;

/// An attribute, and the properties of the element that are its components.
struct Column {
  NamedAttribute attribute;
  std::vector<std::size_t> properties;
};

constexpr const char *rgba[] = {"red", "green", "blue", "alpha"};

/// The properties of an attribute: one of its name; `wear_x`, `wear_y` and so on, or `wear_u` and
/// `wear_v`; of `color` red, green, blue and perhaps alpha. Empty if there are none.
std::vector<std::size_t> propertiesOf(const Element &element, const std::string &name) {
  const auto find = [&](const std::string &property) {
    const auto found =
        std::find_if(element.properties.begin(), element.properties.end(),
                     [&](const Property &one) { return !one.isList && one.name == property; });
    return std::size_t(found - element.properties.begin());
  };
  const std::size_t none = element.properties.size();
  if (const std::size_t alone = find(name); alone != none)
    return {alone};
  std::vector<std::vector<std::string>> sets(2);
  for (const char *axis : {"_x", "_y", "_z", "_w"})
    sets[0].push_back(name + axis);
  for (const char *axis : {"_u", "_v"})
    sets[1].push_back(name + axis);
  if (name == "color")
    sets.emplace_back(std::begin(rgba), std::end(rgba));
  for (const auto &set : sets) {
    std::vector<std::size_t> properties;
    for (const std::string &property : set)
      if (const std::size_t place = find(property); place != none)
        properties.push_back(place);
      else
        break;
    if (properties.size() > 1)
      return properties;
  }
  return {};
}

/// The name of the attribute that a property is part of.
std::string attributeOf(const std::string &property) {
  if (std::find(std::begin(rgba), std::end(rgba), property) != std::end(rgba))
    return "color";
  const std::size_t length = property.size();
  if (length > 2 && property[length - 2] == '_' &&
      std::string_view("xyzwuv").find(property.back()) != std::string_view::npos)
    return property.substr(0, length - 2);
  return property;
}

/// Is it a face's list of vertices?
bool isCorners(const Property &property) {
  return property.isList && (property.name == "vertex_indices" || property.name == "vertex_index");
}

/// Numbers of 8 and 16 bits that are colors count from 0 to 1.
double scaleOf(Type type) {
  return type == Type::UInt8 ? 1 / 255.0 : type == Type::UInt16 ? 1 / 65535.0 : 1;
}

class Reader {
public:
  Reader(std::string_view bytes, const Header &header, const MeshRequest &request)
      : body(bytes, header), header(header), request(request) {}

  bool readAll() {
    for (const Element &element : header.elements) {
      const bool isRead = element.name == "vertex" ? readVertices(element)
                          : element.name == "face" ? readFaces(element)
                                                   : skipElement(element);
      if (!isRead)
        return false;
    }
    if (request.keepsOrder)
      mesh.order = {true, mesh.vertexCount(), faceCount, {}, std::move(facesOfTriangles)};
    return !mesh.indices.empty();
  }

  Mesh mesh;

private:
  /// The requested attributes of an element, for so many vertices or triangles. One that the
  /// vertices have is not read of the faces.
  std::vector<Column> columnsOf(const Element &element, bool ofTriangles, std::size_t count) {
    std::vector<Column> columns;
    for (const std::string &name : request.attributes) {
      const std::vector<std::size_t> properties = propertiesOf(element, name);
      const bool isKnown =
          std::any_of(mesh.attributes.begin(), mesh.attributes.end(),
                      [&](const NamedAttribute &other) { return other.name == name; });
      if (properties.empty() || isKnown)
        continue;
      Column column{{}, properties};
      column.attribute.name = name;
      column.attribute.components = std::uint32_t(properties.size());
      column.attribute.words.resize(properties.size() * count);
      column.attribute.ofTriangles = ofTriangles;
      column.attribute.isRgb = name == "color" && properties.size() >= 3;
      const Type type = element.properties[properties.front()].type;
      if (ofTriangles && !isFloating(type) && !column.attribute.isRgb)
        column.attribute.kind =
            type == Type::UInt32 ? NamedAttribute::Kind::UInt : NamedAttribute::Kind::Int;
      columns.push_back(std::move(column));
    }
    for (const Property &property : element.properties) {
      const std::string name = attributeOf(property.name);
      if (!property.isList && !targetOf(property.name).to && !request.wants(name) &&
          std::find(mesh.otherAttributes.begin(), mesh.otherAttributes.end(), name) ==
              mesh.otherAttributes.end())
        mesh.otherAttributes.push_back(name);
    }
    return columns;
  }

  /// The column and component that each property is; null: none.
  static std::vector<Column *> byProperty(const Element &element, std::vector<Column> &columns) {
    std::vector<Column *> found(element.properties.size(), nullptr);
    for (Column &column : columns)
      for (const std::size_t property : column.properties)
        found[property] = &column;
    return found;
  }

  /// Reads a number of an attribute; the properties of one come in any order.
  static bool readComponent(Body &body, const Property &property, std::size_t number,
                            Column &column, std::size_t index, std::size_t copies) {
    double value;
    if (!body.readNumber(property.type, value))
      return false;
    NamedAttribute &attribute = column.attribute;
    const std::size_t components = attribute.components;
    const auto component =
        std::size_t(std::find(column.properties.begin(), column.properties.end(), number) -
                    column.properties.begin());
    std::uint32_t word;
    if (attribute.kind == NamedAttribute::Kind::Float) {
      const auto single = float(attribute.isRgb ? value * scaleOf(property.type) : value);
      std::memcpy(&word, &single, sizeof word);
    } else {
      word = std::uint32_t(std::int64_t(value));
    }
    for (std::size_t i = 0; i < copies; ++i)
      attribute.words[components * (index + i) + component] = word;
    return true;
  }

  void keep(std::vector<Column> &columns) {
    for (Column &column : columns)
      mesh.attributes.push_back(std::move(column.attribute));
  }

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
    std::vector<Column> columns = columnsOf(element, false, element.count);
    const std::vector<Column *> columnOf = byProperty(element, columns);
    mesh.positions = largeVector<float>(3 * element.count);
    mesh.normals = largeVector<float>(normals ? 3 * element.count : 0);
    mesh.uvs = largeVector<float>(uvs ? 2 * element.count : 0);
    const auto readRow = [&](Body &row, std::size_t i) {
      for (std::size_t p = 0; p < targets.size(); ++p) {
        const Property &property = element.properties[p];
        const auto [to, component] = targets[p];
        const bool isRead =
            to ? row.readFloat(property.type, (*to)[(to == &mesh.uvs ? 2 : 3) * i + component])
            : columnOf[p] ? readComponent(row, property, p, *columnOf[p], i, 1)
                          : row.skip(property);
        if (!isRead)
          return false;
      }
      return true;
    };
    const std::optional<std::vector<Rows>> rows = rowsOfVertices(element);
    const bool isRead = rows && forAll(*rows, [&](const Rows &part) {
                          Body row = part.body;
                          for (std::size_t i = part.first; i < part.end; ++i)
                            if (!readRow(row, i))
                              return false;
                          return true;
                        });
    keep(columns);
    return isRead;
  }

  /// Calls `read` for all parts, on all cores. False if one call is.
  template <typename Read>
  static bool forAll(const std::vector<Rows> &rows, Read read) {
    std::atomic<bool> isGood{true};
    forEachInParallel(0, rows.size(), [&](std::size_t i) {
      if (!isGood || !read(rows[i]))
        isGood = false;
    });
    return isGood;
  }

  /// The rows of an element without lists, which the body passes. Nothing if there are fewer.
  std::optional<std::vector<Rows>> rowsOfVertices(const Element &element) {
    std::vector<Rows> rows;
    for (std::size_t first = 0; first < element.count; first += rowsAtOnce) {
      const std::size_t end = std::min<std::size_t>(element.count, first + rowsAtOnce);
      rows.push_back({body, first, end, 0});
      if (!body.skipRows(element, end - first))
        return std::nullopt;
    }
    return rows;
  }

  /// The same of faces, which are triangles and quadrilaterals; property number `list` has their
  /// corners.
  std::optional<std::vector<Rows>> rowsOfFaces(const Element &element, std::size_t list) {
    std::vector<Rows> rows;
    std::size_t triangles = 0;
    for (std::size_t i = 0; i < element.count; ++i) {
      if (i % rowsAtOnce == 0)
        rows.push_back({body, i, std::min<std::size_t>(element.count, i + rowsAtOnce), triangles});
      for (std::size_t p = 0; p < element.properties.size(); ++p) {
        const Property &property = element.properties[p];
        std::uint64_t corners = 3;
        if (p == list &&
            (!Body(body).readCount(property.countType, corners) || corners < 3 || corners > 4))
          return std::nullopt;
        if (!body.skip(property))
          return std::nullopt;
        if (p == list)
          triangles += corners - 2;
      }
    }
    rows.push_back({body, element.count, element.count, triangles});
    return rows;
  }

  bool readFaces(const Element &element) {
    if (mesh.positions.empty() || !mesh.indices.empty())
      return false;
    const auto lists = std::count_if(element.properties.begin(), element.properties.end(),
                                     [](const Property &property) { return property.isList; });
    if (lists != 1 || std::none_of(element.properties.begin(), element.properties.end(), isCorners))
      return false;
    const auto list =
        std::size_t(std::find_if(element.properties.begin(), element.properties.end(), isCorners) -
                    element.properties.begin());
    const std::optional<std::vector<Rows>> rows = rowsOfFaces(element, list);
    if (!rows)
      return false;
    const std::size_t triangles = rows->back().firstTriangle;
    std::vector<Column> columns = columnsOf(element, true, triangles);
    mesh.indices = largeVector<std::uint32_t>(3 * triangles);
    if (request.keepsOrder)
      facesOfTriangles.resize(triangles);
    faceCount = element.count;
    const bool isRead =
        forAll(*rows, [&](const Rows &part) { return readFaces(element, list, columns, part); });
    keep(columns);
    return isRead;
  }

  bool readFaces(const Element &element, std::size_t list, std::vector<Column> &columns,
                 const Rows &part) {
    const std::vector<Column *> columnOf = byProperty(element, columns);
    std::size_t triangle = part.firstTriangle;
    Body row = part.body;
    for (std::size_t i = part.first; i < part.end; ++i) {
      const Body start = row;
      for (std::size_t p = 0; p < list; ++p) // read when it is known how many triangles there are
        row.skip(element.properties[p]);
      const std::size_t added = readFace(row, element.properties[list], triangle);
      if (added == 0)
        return false;
      const Body afterCorners = row;
      if (!columns.empty())
        row = start;
      for (std::size_t p = columns.empty() ? list + 1 : 0; p < element.properties.size(); ++p) {
        if (p == list)
          row = afterCorners;
        else if (!(columnOf[p]
                       ? readComponent(row, element.properties[p], p, *columnOf[p], triangle, added)
                       : row.skip(element.properties[p])))
          return false;
      }
      if (request.keepsOrder)
        std::fill_n(&facesOfTriangles[triangle], added, std::uint32_t(i));
      triangle += added;
    }
    return true;
  }

  /// Reads the corners of the triangles of a face, from this one. Returns how many there are; 0: a
  /// corner is not valid.
  std::size_t readFace(Body &row, const Property &property, std::size_t triangle) {
    std::uint64_t count;
    if (!row.readCount(property.countType, count) || count < 3 || count > 4)
      return 0;
    std::array<std::uint64_t, 4> corners{};
    for (std::size_t i = 0; i < count; ++i)
      if (!row.readCount(property.type, corners[i]) || corners[i] >= mesh.vertexCount())
        return 0;
    auto position = [&](int corner) { return &mesh.positions[3 * corners[std::size_t(corner)]]; };
    const std::size_t first =
        count == 3
            ? 0
            : std::size_t(cornerOfDiagonal({position(0), position(1), position(2), position(3)}));
    std::uint32_t *to = &mesh.indices[3 * triangle];
    for (std::size_t i = 1; i + 1 < count; ++i)
      for (std::size_t corner : {first, first + i, first + i + 1})
        *to++ = std::uint32_t(corners[corner % count]);
    return count - 2;
  }

  bool skipElement(const Element &element) {
    if (element.name == "tristrips") // which contain faces, too
      return false;
    return element.properties.empty() || body.skipRows(element, element.count);
  }

  Body body;
  const Header &header;
  const MeshRequest &request;
  std::vector<std::uint32_t> facesOfTriangles;
  std::size_t faceCount = 0;
};

} // namespace

std::optional<Mesh> readPlainPly(std::string_view bytes, const MeshRequest &request) {
  if (!isPly(bytes))
    return std::nullopt;
  const std::optional<Header> header = readHeader(bytes);
  if (!header)
    return std::nullopt;
  Reader reader(bytes, *header, request);
  if (!reader.readAll())
    return std::nullopt;
  normalize(reader.mesh.normals);
  return std::move(reader.mesh);
}

namespace {

/// Finds a property that a mesh needs and its elements lack; else reads the values of all elements,
/// and finds the first that is not valid.
class DamageFinder {
public:
  DamageFinder(std::string_view bytes, const Header &header, const std::string &path)
      : body(bytes, header), header(header), path(path) {
    for (const Element &element : header.elements)
      if (element.name == "vertex")
        vertexCount += element.count;
  }

  std::optional<Message> find() {
    for (const Element &element : header.elements)
      if (const char *missing = missingIn(element))
        return message::meshPropertyMissing(path, element.name, missing);
    for (const Element &element : header.elements)
      for (std::uint64_t i = 0; i < element.count && !element.properties.empty(); ++i)
        for (const Property &property : element.properties)
          if (std::optional<Message> damage = readNext(element, i, property))
            return damage;
    return std::nullopt;
  }

private:
  /// Null: the element has what it needs.
  static const char *missingIn(const Element &element) {
    const std::vector<Property> &properties = element.properties;
    if (element.name == "vertex")
      for (const char *axis : {"x", "y", "z"})
        if (std::none_of(properties.begin(), properties.end(),
                         [&](const Property &one) { return one.name == axis; }))
          return axis;
    const bool hasCorners = element.name != "face" || element.count == 0 ||
                            std::any_of(properties.begin(), properties.end(), isCorners);
    return hasCorners ? nullptr : "vertex_indices";
  }

  std::optional<Message> readNext(const Element &element, std::uint64_t row,
                                  const Property &property) {
    const bool areCorners = element.name == "face" && isCorners(property);
    std::uint64_t count = 1;
    if (property.isList && !body.readCount(property.countType, count))
      return unreadable(element, row);
    if (areCorners && count == 0)
      return message::meshFaceEmpty(path, row + 1, element.count);
    for (; count > 0; --count) {
      double number;
      if (!body.readNumber(property.type, number))
        return unreadable(element, row);
      if (areCorners &&
          !(number >= 0 && number < double(vertexCount) && number == std::floor(number)))
        return message::meshFaceCorner(path, row + 1, element.count, number, vertexCount);
    }
    return std::nullopt;
  }

  /// The value after the last one that could be read.
  Message unreadable(const Element &element, std::uint64_t row) const {
    if (body.lastWord().empty())
      return message::meshTruncated(path, row + 1, element.count, element.name);
    return message::meshElementNotNumber(path, row + 1, element.count, element.name,
                                         body.lastWord());
  }

  Body body;
  const Header &header;
  const std::string &path;
  std::uint64_t vertexCount = 0;
};

} // namespace

std::optional<Message> findPlyDamage(std::string_view bytes, const std::string &path) {
  if (!isPly(bytes))
    return message::meshIsNoPly(path);
  std::size_t line = 0;
  const std::optional<Header> header = readHeader(bytes, &line);
  if (!header)
    return message::meshHeaderDamaged(path, line);
  return DamageFinder(bytes, *header, path).find();
}

} // namespace rtsl::runtime
