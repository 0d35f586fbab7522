#include "runtime/geometry/ObjFile.h"

#include "runtime/geometry/CornerNumbers.h"
#include "runtime/geometry/Normals.h"
#include "runtime/geometry/ObjLines.h"
#include "runtime/geometry/PolygonSplit.h"
#include "support/LargeArray.h"
#include "support/Parallel.h"

#include <algorithm>
#include <atomic>
#include <functional>
#include <map>
#include <string>
#include <utility>

namespace rtsl::runtime {

namespace {

using obj::none;

/// What a file holds, before vertices are made.
struct Contents {
  std::vector<obj::Part> parts;
  obj::Numbers numbers;
};

/// Nothing if the file is not plain.
std::optional<Contents> readContents(std::string_view text, bool wantsColors,
                                     std::size_t bytesOfPart) {
  std::vector<obj::Part> parts = obj::cutIntoParts(text, bytesOfPart);
  std::vector<obj::LineCounts> counts(parts.size());
  forEachInParallel(0, parts.size(),
                    [&](std::size_t i) { counts[i] = obj::countLines(parts[i].text); });
  obj::LineCounts above;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    parts[i].before = above;
    parts[i].faceLines = counts[i].faces;
    above.add(counts[i]);
  }
  obj::Numbers numbers(above, wantsColors);
  std::atomic<bool> isPlain{true};
  forEachInParallel(0, parts.size(), [&](std::size_t i) {
    if (!isPlain || !obj::readLines(parts[i], numbers))
      isPlain = false;
  });
  const bool hasTriangles = std::any_of(
      parts.begin(), parts.end(), [](const obj::Part &part) { return part.triangleCount != 0; });
  if (!isPlain || !hasTriangles)
    return std::nullopt;
  return Contents{std::move(parts), std::move(numbers)};
}

/// Replaces the first index of each corner by the number of its vertex. Returns the corner of each
/// vertex.
template <std::size_t width>
std::vector<std::uint32_t> numberVertices(Contents &contents) {
  CornerNumbers<width> numbers(contents.numbers.positions.size() / 3);
  for (obj::Part &part : contents.parts)
    for (std::size_t i = 0; i < part.corners.size(); i += width)
      part.corners[i] = numbers.of(&part.corners[i]);
  return numbers.take();
}

std::vector<std::uint32_t> numberVertices(Contents &contents) {
  switch (contents.numbers.cornerWidth()) {
  case 1:
    return numberVertices<1>(contents);
  case 2:
    return numberVertices<2>(contents);
  default:
    return numberVertices<3>(contents);
  }
}

/// An index of the corner of each vertex.
struct Indices {
  const std::vector<std::uint32_t> &corners;
  std::size_t width, place; // of a corner, and in it

  std::size_t count() const { return corners.size() / width; }
  std::uint32_t operator[](std::size_t vertex) const { return corners[width * vertex + place]; }
};

/// The `components` floats of each vertex. Empty if no vertex has any; zeros for vertices without
/// them.
std::vector<float> gather(const std::vector<float> &from, std::size_t components,
                          const Indices &indices) {
  if (from.empty())
    return {};
  std::vector<float> gathered = largeVector<float>(components * indices.count());
  std::atomic<bool> anyHas{false};
  forRangesInParallel(0, indices.count(), 1 << 16, [&](std::size_t first, std::size_t end) {
    bool has = false;
    for (std::size_t i = first; i < end; ++i) {
      if (indices[i] == none)
        continue;
      has = true;
      std::copy_n(&from[components * indices[i]], components, &gathered[components * i]);
    }
    if (has)
      anyHas = true;
  });
  return anyHas ? std::move(gathered) : std::vector<float>();
}

/// The attribute `color`, if every position has one.
void addColors(Mesh &mesh, const Contents &contents, const Indices &positions, bool wanted) {
  std::size_t count = 0;
  for (const obj::Part &part : contents.parts)
    count += part.colorCount;
  if (count != 0 && !wanted)
    mesh.otherAttributes.push_back("color");
  const std::vector<float> &colors = contents.numbers.colors;
  if (colors.empty() || 3 * count != colors.size())
    return;
  mesh.attributes.push_back(floatAttribute("color", 3, gather(colors, 3, positions)));
  mesh.attributes.back().isRgb = true;
}

/// Triangles of a part, whose corners begin with the numbers of vertices.
void addTriangles(const obj::Part &part, std::size_t width, const Mesh &mesh, std::uint32_t *to) {
  const std::uint32_t *corner = part.corners.data();
  for (const std::uint8_t size : part.faceSizes) {
    std::uint32_t vertices[4];
    for (unsigned i = 0; i < size; ++i, corner += width)
      vertices[i] = *corner;
    unsigned first = 0;
    if (size == 4) {
      const auto position = [&](unsigned i) {
        return &mesh.positions[3 * std::size_t(vertices[i])];
      };
      first = unsigned(cornerOfDiagonal({position(0), position(1), position(2), position(3)}));
    }
    for (unsigned i = 1; i + 1 < size; ++i)
      for (const unsigned c : {first, first + i, first + i + 1})
        *to++ = vertices[c % size];
  }
}

/// The number of the first triangle of each part, and that of all triangles.
std::vector<std::size_t> firstTriangles(const std::vector<obj::Part> &parts) {
  std::vector<std::size_t> first{0};
  for (const obj::Part &part : parts)
    first.push_back(first.back() + part.triangleCount);
  return first;
}

FileOrder orderOf(const Contents &contents, const Indices &positions) {
  FileOrder order{true, contents.numbers.positions.size() / 3, 0, {}, {}};
  for (std::size_t i = 0; i < positions.count(); ++i)
    order.vertices.push_back(positions[i]);
  for (const obj::Part &part : contents.parts)
    for (const std::uint8_t size : part.faceSizes)
      order.faces.insert(order.faces.end(), size - 2u, std::uint32_t(order.faceCount++));
  return order;
}

Mesh meshOf(Contents contents, const MeshRequest &request) {
  const std::size_t width = contents.numbers.cornerWidth();
  const std::vector<std::uint32_t> corners = numberVertices(contents);
  const Indices positions{corners, width, 0};
  Mesh mesh;
  normalize(contents.numbers.normals);
  mesh.positions = gather(contents.numbers.positions, 3, positions);
  mesh.normals = gather(contents.numbers.normals, 3, {corners, width, width - 1});
  mesh.uvs = gather(contents.numbers.uvs, 2, {corners, width, 1});
  const std::vector<std::size_t> first = firstTriangles(contents.parts);
  mesh.indices = largeVector<std::uint32_t>(3 * first.back());
  forEachInParallel(0, contents.parts.size(), [&](std::size_t i) {
    addTriangles(contents.parts[i], width, mesh, mesh.indices.data() + 3 * first[i]);
  });
  addColors(mesh, contents, positions, request.wants("color"));
  if (request.keepsOrder)
    mesh.order = orderOf(contents, positions);
  return mesh;
}

/// Some triangles of a mesh, with the vertices that they use. `places` are `none`, before and
/// after.
Mesh someOf(const Mesh &whole, const std::vector<std::uint32_t> &triangles,
            std::vector<std::uint32_t> &places) {
  Mesh mesh;
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
  const auto gather = [&](const auto &from, auto &to, std::size_t width) {
    for (const std::uint32_t vertex : used)
      if (!from.empty())
        to.insert(to.end(), &from[width * vertex], &from[width * vertex] + width);
  };
  gather(whole.positions, mesh.positions, 3);
  gather(whole.normals, mesh.normals, 3);
  gather(whole.uvs, mesh.uvs, 2);
  for (const NamedAttribute &attribute : whole.attributes) {
    mesh.attributes.push_back(attribute);
    mesh.attributes.back().words.clear();
    gather(attribute.words, mesh.attributes.back().words, attribute.components);
  }
  for (const std::uint32_t vertex : used)
    places[vertex] = none;
  return mesh;
}

/// The uses of materials in the whole file.
std::vector<obj::MaterialUse> usesOf(const std::vector<obj::Part> &parts) {
  const std::vector<std::size_t> first = firstTriangles(parts);
  std::vector<obj::MaterialUse> uses;
  for (std::size_t i = 0; i < parts.size(); ++i)
    for (const obj::MaterialUse &use : parts[i].uses)
      uses.push_back({first[i] + use.firstTriangle, use.material});
  return uses;
}

/// The triangles of each material, by the name of the last `usemtl` above them.
std::vector<MeshGroup> groupsOf(const Mesh &whole, const std::vector<obj::MaterialUse> &uses) {
  std::vector<MeshGroup> groups;
  std::map<std::string, std::size_t, std::less<>> numbers;
  std::vector<std::vector<std::uint32_t>> triangles; // of each group
  std::size_t use = 0, group = none;
  for (std::uint32_t i = 0; i < whole.triangleCount(); ++i) {
    const std::size_t before = use;
    while (use < uses.size() && uses[use].firstTriangle <= i)
      ++use;
    if (use != before || group == none) {
      const std::string name(use == 0 ? std::string_view() : uses[use - 1].material);
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
    groups[i].mesh = someOf(whole, triangles[i], places);
  return groups;
}

} // namespace

std::optional<Mesh> readPlainObj(std::string_view text, const MeshRequest &request,
                                 std::size_t bytesOfPart) {
  std::optional<Contents> contents = readContents(text, request.wants("color"), bytesOfPart);
  if (!contents)
    return std::nullopt;
  return meshOf(std::move(*contents), request);
}

std::optional<std::vector<MeshGroup>> readPlainObjGroups(std::string_view text,
                                                         std::size_t bytesOfPart) {
  std::optional<Contents> contents = readContents(text, true, bytesOfPart);
  if (!contents)
    return std::nullopt;
  const std::vector<obj::MaterialUse> uses = usesOf(contents->parts);
  return groupsOf(meshOf(std::move(*contents), {{"color"}, false}), uses);
}

} // namespace rtsl::runtime
