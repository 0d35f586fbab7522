#include "runtime/geometry/PlyFile.h"

#include "runtime/geometry/Normals.h"
#include "runtime/geometry/PlyFormat.h"
#include "runtime/geometry/PolygonSplit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace rtsl::runtime {

using namespace ply;

namespace {

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
  if (!isPly(bytes))
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
