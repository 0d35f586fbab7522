#include "runtime/geometry/ObjFile.h"

#include "runtime/geometry/Normals.h"
#include "runtime/geometry/PolygonSplit.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <map>
#include <string>

namespace rtsl::runtime {

namespace {

constexpr std::uint32_t none = ~std::uint32_t(0);

/// The indices of a corner of a face, counted from 0.
struct Corner {
  std::uint32_t position = none, uv = none, normal = none;

  bool operator==(const Corner &other) const {
    return position == other.position && uv == other.uv && normal == other.normal;
  }
};

/// Turns corners into vertices; equal corners share one.
class Vertices {
public:
  std::uint32_t add(const Corner &corner) {
    if (corner.position >= firstAt.size())
      firstAt.resize(corner.position + std::size_t(1), none);
    std::uint32_t *link = &firstAt[corner.position];
    while (*link != none) {
      Vertex &vertex = vertices[*link];
      if (vertex.corner == corner)
        return *link;
      link = &vertex.nextAt;
    }
    const auto number = std::uint32_t(vertices.size());
    *link = number;
    vertices.push_back({corner, none});
    return number;
  }

  /// The position of each vertex.
  std::vector<std::uint32_t> positions() const {
    std::vector<std::uint32_t> numbers;
    numbers.reserve(vertices.size());
    for (const Vertex &vertex : vertices)
      numbers.push_back(vertex.corner.position);
    return numbers;
  }

  void reserve(std::size_t count) {
    vertices.reserve(count);
    firstAt.reserve(count);
  }

  /// `width` floats per vertex, those in `from` at its `index`. Empty if no vertex has any; zeros
  /// for vertices without them.
  std::vector<float> gather(const std::vector<float> &from, std::uint32_t Corner::*index,
                            std::size_t width) const {
    auto has = [&](const Vertex &vertex) { return vertex.corner.*index != none; };
    if (std::none_of(vertices.begin(), vertices.end(), has))
      return {};
    std::vector<float> gathered(width * vertices.size(), 0.0f);
    for (std::size_t i = 0; i < vertices.size(); ++i)
      if (has(vertices[i]))
        std::copy_n(&from[width * (vertices[i].corner.*index)], width, &gathered[width * i]);
    return gathered;
  }

private:
  struct Vertex {
    Corner corner;
    std::uint32_t nextAt; // another one with the same position
  };
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> firstAt; // by position
};

/// Reads line by line. Functions return false if the file is not plain.
class Reader {
public:
  Reader(std::string_view text, const MeshRequest &request)
      : at(text.data()), end(text.data() + text.size()), request(request),
        wantsColors(request.wants("color")) {}

  bool readAll() {
    makeRoom();
    while (at != end)
      if (!readLine())
        return false;
    return !indices.empty();
  }

  /// The triangles of each material, by the name of the last `usemtl` above them.
  std::vector<MeshGroup> takeGroups() {
    const std::vector<MaterialUse> used = std::move(uses);
    const Mesh whole = takeMesh();
    std::vector<MeshGroup> groups;
    std::map<std::string, std::size_t, std::less<>> numbers;
    std::vector<std::vector<std::uint32_t>> triangles; // of each group
    std::size_t use = 0, group = none;
    for (std::uint32_t i = 0; i < whole.triangleCount(); ++i) {
      const std::size_t before = use;
      while (use < used.size() && used[use].firstIndex <= 3 * std::size_t(i))
        ++use;
      if (use != before || group == none) {
        const std::string name(use == 0 ? std::string_view() : used[use - 1].material);
        const auto [known, isNew] = numbers.emplace(name, groups.size());
        group = known->second;
        if (isNew) {
          groups.push_back({name, {}});
          triangles.emplace_back();
        }
      }
      triangles[group].push_back(i);
    }
    std::vector<std::uint32_t> places(whole.vertexCount(), none); // in the group that is made
    for (std::size_t i = 0; i < groups.size(); ++i)
      groups[i].mesh = part(whole, triangles[i], places);
    return groups;
  }

  Mesh takeMesh() {
    normalize(normals);
    Mesh mesh;
    mesh.positions = vertices.gather(positions, &Corner::position, 3);
    mesh.normals = vertices.gather(normals, &Corner::normal, 3);
    mesh.uvs = vertices.gather(uvs, &Corner::uv, 2);
    mesh.indices = std::move(indices);
    addColors(mesh);
    if (request.keepsOrder)
      mesh.order = {true, positions.size() / 3, faceCount, vertices.positions(), std::move(faces)};
    return mesh;
  }

private:
  struct MaterialUse {
    std::size_t firstIndex; // of the triangles that follow
    std::string_view material;
  };

  /// Some triangles of a mesh, with the vertices that they use. `places` are `none`, before and
  /// after.
  static Mesh part(const Mesh &whole, const std::vector<std::uint32_t> &triangles,
                   std::vector<std::uint32_t> &places) {
    Mesh mesh;
    mesh.otherAttributes = whole.otherAttributes;
    std::vector<std::uint32_t> used;
    for (const std::uint32_t triangle : triangles)
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const std::uint32_t vertex = whole.indices[3 * std::size_t(triangle) + corner];
        if (places[vertex] == none) {
          places[vertex] = std::uint32_t(used.size());
          used.push_back(vertex);
        }
        mesh.indices.push_back(places[vertex]);
      }
    const auto gather = [&](const std::vector<float> &from, std::vector<float> &to,
                            std::size_t width) {
      for (const std::uint32_t vertex : used)
        if (!from.empty())
          to.insert(to.end(), &from[width * vertex], &from[width * vertex] + width);
    };
    gather(whole.positions, mesh.positions, 3);
    gather(whole.normals, mesh.normals, 3);
    gather(whole.uvs, mesh.uvs, 2);
    for (const std::uint32_t vertex : used)
      places[vertex] = none;
    return mesh;
  }

  /// The attribute `color`, if every position has one.
  void addColors(Mesh &mesh) const {
    if (hasColors && !wantsColors)
      mesh.otherAttributes.push_back("color");
    if (colors.empty() || colors.size() != positions.size())
      return;
    mesh.attributes.push_back(
        floatAttribute("color", 3, vertices.gather(colors, &Corner::position, 3)));
    mesh.attributes.back().isRgb = true;
  }

  /// Counts the lines, so that vectors are not reallocated while they are read.
  void makeRoom() {
    std::size_t positionLines = 0, normalLines = 0, uvLines = 0, faces = 0;
    for (const char *line = at; end - line > 1;) {
      positionLines += line[0] == 'v' && line[1] == ' ';
      normalLines += line[0] == 'v' && line[1] == 'n';
      uvLines += line[0] == 'v' && line[1] == 't';
      faces += line[0] == 'f';
      const void *newline = std::memchr(line, '\n', std::size_t(end - line));
      line = newline ? static_cast<const char *>(newline) + 1 : end;
    }
    positions.reserve(3 * positionLines);
    normals.reserve(3 * normalLines);
    uvs.reserve(2 * uvLines);
    indices.reserve(3 * faces);
    vertices.reserve(positionLines);
  }

  static bool isBlank(char c) { return c == ' ' || c == '\t'; }
  bool isAtEnd() const { return at == end || *at == '\n' || *at == '\r'; }
  void skipBlanks() {
    while (at != end && isBlank(*at))
      ++at;
  }

  std::string_view readWord() {
    const char *start = at;
    while (!isAtEnd() && !isBlank(*at))
      ++at;
    return {start, std::size_t(at - start)};
  }

  /// True if only blanks remain.
  bool endLine() {
    skipBlanks();
    if (at != end && *at == '\r')
      ++at;
    if (at == end)
      return true;
    return *at++ == '\n';
  }

  /// Ignores the rest of the line. A backslash at its end would continue it on the next line.
  bool skipLine() {
    const char *start = at;
    const void *newline = std::memchr(at, '\n', std::size_t(end - at));
    const char *last = newline ? static_cast<const char *>(newline) : end;
    at = newline ? last + 1 : end;
    if (last != start && last[-1] == '\r')
      --last;
    return last == start || last[-1] != '\\';
  }

  bool readLine() {
    skipBlanks();
    if (isAtEnd())
      return endLine();
    if (*at == '#')
      return skipLine();
    const std::string_view word = readWord();
    if (word == "v")
      return readPosition();
    if (word == "vn")
      return readNumbers(normals, 3) && endLine();
    if (word == "vt")
      return readTextureCoordinates();
    if (word == "f")
      return readFace();
    if (word == "usemtl")
      return readMaterial();
    const bool meansNothing = word == "g" || word == "o" || word == "s" || word == "mtllib";
    return meansNothing && skipLine();
  }

  /// The rest of the line, which may contain blanks.
  bool readMaterial() {
    skipBlanks();
    const char *start = at, *last = at;
    for (; !isAtEnd(); ++at)
      if (!isBlank(*at))
        last = at + 1;
    uses.push_back({indices.size(), {start, std::size_t(last - start)}});
    return (last == start || last[-1] != '\\') && endLine();
  }

  bool readNumber(float &number) {
    skipBlanks();
    const auto [after, error] = std::from_chars(at, end, number);
    at = after;
    return error == std::errc() && std::isfinite(number) && (isAtEnd() || isBlank(*at));
  }

  bool readNumbers(std::vector<float> &to, int count) {
    for (float number; count > 0; --count) {
      if (!readNumber(number))
        return false;
      to.push_back(number);
    }
    return true;
  }

  /// x y z, optionally with a color. Four numbers would be homogeneous coordinates.
  bool readPosition() {
    if (!readNumbers(positions, 3))
      return false;
    skipBlanks();
    if (isAtEnd())
      return endLine();
    hasColors = true;
    std::array<float, 3> color;
    for (float &component : color)
      if (!readNumber(component))
        return false;
    if (wantsColors)
      colors.insert(colors.end(), color.begin(), color.end());
    return endLine();
  }

  /// u v, optionally with w.
  bool readTextureCoordinates() {
    if (!readNumbers(uvs, 2))
      return false;
    skipBlanks();
    float ignored;
    return (isAtEnd() || readNumber(ignored)) && endLine();
  }

  /// An index counts from 1, or, if negative, backwards from the last one before the face.
  bool readIndex(std::size_t count, std::uint32_t &index) {
    std::int64_t number;
    const auto [after, error] = std::from_chars(at, end, number);
    at = after;
    if (error != std::errc() || number == 0 || count >= none)
      return false;
    if (number < 0)
      number += std::int64_t(count) + 1;
    index = std::uint32_t(number - 1);
    return number > 0 && number <= std::int64_t(count);
  }

  bool skip(char c) {
    if (at == end || *at != c)
      return false;
    ++at;
    return true;
  }

  /// v, v/vt, v//vn or v/vt/vn.
  bool readCorner(Corner &corner) {
    if (!readIndex(positions.size() / 3, corner.position))
      return false;
    if (skip('/')) {
      if (at != end && *at != '/' && !readIndex(uvs.size() / 2, corner.uv))
        return false;
      if (skip('/') && !readIndex(normals.size() / 3, corner.normal))
        return false;
    }
    return isAtEnd() || isBlank(*at);
  }

  bool readFace() {
    std::array<Corner, 4> corners;
    int count = 0;
    for (skipBlanks(); !isAtEnd(); skipBlanks()) {
      if (count == 4 || !readCorner(corners[std::size_t(count)]))
        return false;
      ++count;
    }
    if (count < 3)
      return false;
    std::array<std::uint32_t, 4> vertex;
    for (int i = 0; i < count; ++i)
      vertex[std::size_t(i)] = vertices.add(corners[std::size_t(i)]);
    int first = 0;
    if (count == 4)
      first = cornerOfDiagonal(
          {position(corners[0]), position(corners[1]), position(corners[2]), position(corners[3])});
    for (int i = 1; i + 1 < count; ++i)
      for (int corner : {first, first + i, first + i + 1})
        indices.push_back(vertex[std::size_t(corner % count)]);
    if (request.keepsOrder)
      faces.insert(faces.end(), std::size_t(count - 2), std::uint32_t(faceCount));
    ++faceCount;
    return endLine();
  }

  const float *position(const Corner &corner) const {
    return &positions[3 * std::size_t(corner.position)];
  }

  const char *at, *end;
  const MeshRequest &request;
  const bool wantsColors;
  bool hasColors = false;
  std::vector<float> positions, normals, uvs, colors; // as the file numbers them
  std::vector<std::uint32_t> faces;                   // of each triangle
  std::size_t faceCount = 0;
  Vertices vertices;
  std::vector<std::uint32_t> indices;
  std::vector<MaterialUse> uses; // in the order of the file
};

} // namespace

std::optional<Mesh> readPlainObj(std::string_view text, const MeshRequest &request) {
  Reader reader(text, request);
  if (!reader.readAll())
    return std::nullopt;
  return reader.takeMesh();
}

std::optional<std::vector<MeshGroup>> readPlainObjGroups(std::string_view text) {
  const MeshRequest nothing;
  Reader reader(text, nothing);
  if (!reader.readAll())
    return std::nullopt;
  return reader.takeGroups();
}

} // namespace rtsl::runtime
