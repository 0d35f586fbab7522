#include "runtime/geometry/Mesh.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace rtsl::runtime {

void Mesh::apply(const Transform &transform, NormalLengths lengths) {
  const auto &c = transform.columns;
  for (std::size_t i = 0; i + 2 < positions.size(); i += 3) {
    double x = positions[i], y = positions[i + 1], z = positions[i + 2];
    for (int row = 0; row < 3; ++row)
      positions[i + row] = float(c[0][row] * x + c[1][row] * y + c[2][row] * z + c[3][row]);
  }
  const auto cofactors = normalTransform(transform);
  double size = 0; // of the largest
  for (const auto &column : cofactors)
    size = std::max(size, std::hypot(column[0], column[1], column[2]));
  for (std::size_t i = 0; i + 2 < normals.size(); i += 3) {
    double x = normals[i], y = normals[i + 1], z = normals[i + 2], n[3];
    for (int row = 0; row < 3; ++row)
      n[row] = cofactors[0][row] * x + cofactors[1][row] * y + cofactors[2][row] * z;
    double length = lengths == NormalLengths::Alike ? size : std::hypot(n[0], n[1], n[2]);
    for (int row = 0; row < 3; ++row)
      normals[i + row] = length > 0 ? float(n[row] / length) : 0.0f;
  }
  for (NamedAttribute &attribute : attributes)
    runtime::apply(transform, attribute);
  if (transform.determinant() < 0)
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
      std::swap(indices[i + 1], indices[i + 2]);
}

namespace {

/// Products of three coordinates, and Embree's arithmetic, stay well within the range of a float.
constexpr float largestCoordinate = 1e18f;

constexpr std::uint32_t mostAttributeComponents = 16; // of a color
constexpr auto FloatKind = NamedAttribute::Kind::Float;

void validateAttribute(const Mesh &mesh, const NamedAttribute &attribute, const std::string &name) {
  const char *what = attribute.ofTriangles ? "triangles" : "vertices";
  const std::size_t count = attribute.ofTriangles ? mesh.triangleCount() : mesh.vertexCount();
  if (attribute.components < 1 || attribute.components > mostAttributeComponents)
    throw Error(message::attributeTooWide(name, attribute.name, attribute.components,
                                          mostAttributeComponents),
                Place{name});
  if (attribute.words.size() != attribute.components * count)
    throw Error(message::attributeSize(name, attribute.words.size(), attribute.name, count, what,
                                       attribute.components),
                Place{name});
  if (const std::uint32_t needed = componentsOf(attribute.space);
      needed != 0 && (attribute.components != needed || attribute.kind != FloatKind))
    throw Error(message::attributeNotOfSpace(name, attribute.name, attribute.components,
                                             nameOf(attribute.space), needed),
                Place{name});
  if (attribute.kind != FloatKind) {
    if (!attribute.ofTriangles)
      throw Error(message::attributeIntegersOfVertices(name, attribute.name), Place{name});
    return;
  }
  for (std::size_t i = 0; i < attribute.words.size(); ++i) {
    float number;
    std::memcpy(&number, &attribute.words[i], sizeof number);
    if (!std::isfinite(number))
      throw Error(message::attributeNotFinite(name, attribute.name,
                                              attribute.ofTriangles ? "triangle" : "vertex",
                                              i / attribute.components),
                  Place{name});
  }
}

} // namespace

void addInFileOrder(Mesh &mesh, NamedAttribute attribute, const std::string &file) {
  if (!mesh.order.isKnown)
    throw Error(message::vertexOrderUnknown(file));
  if (attribute.components < 1 || attribute.components > mostAttributeComponents)
    throw Error(message::attributeTooWide(file, attribute.name, attribute.components,
                                          mostAttributeComponents),
                Place{file});
  const std::size_t given = attribute.words.size() / attribute.components;
  const std::size_t count = attribute.ofTriangles ? mesh.order.faceCount : mesh.order.vertexCount;
  if (given != count)
    throw Error(message::attributeValueCount(attribute.name, given, file, count,
                                             attribute.ofTriangles ? "faces" : "vertices"));
  const auto &places = attribute.ofTriangles ? mesh.order.faces : mesh.order.vertices;
  if (!places.empty()) {
    std::vector<std::uint32_t> words;
    words.reserve(attribute.components * places.size());
    for (const std::size_t place : places)
      words.insert(words.end(), &attribute.words[attribute.components * place],
                   &attribute.words[attribute.components * place] + attribute.components);
    attribute.words = std::move(words);
  }
  const auto known = std::find_if(mesh.attributes.begin(), mesh.attributes.end(),
                                  [&](const auto &one) { return one.name == attribute.name; });
  if (known != mesh.attributes.end())
    *known = std::move(attribute);
  else
    mesh.attributes.push_back(std::move(attribute));
}

Mesh movingMesh(std::vector<Mesh> keys, std::vector<float> times,
                const std::vector<std::string> &names) {
  Mesh result = std::move(keys.front());
  const bool haveNormals = std::all_of(keys.begin() + 1, keys.end(),
                                       [](const Mesh &mesh) { return !mesh.normals.empty(); });
  if (!haveNormals)
    result.normals.clear();
  for (std::size_t i = 1; i < keys.size(); ++i) {
    const Mesh &key = keys[i];
    if (key.vertexCount() != result.vertexCount())
      throw Error(
          message::meshKeyVertices(names[i], key.vertexCount(), names[0], result.vertexCount()),
          Place{names[i]});
    if (key.indices != result.indices)
      throw Error(message::meshKeyTriangles(names[i], names[0]), Place{names[i]});
  }
  for (std::size_t i = 1; i < keys.size(); ++i) {
    const auto append = [](std::vector<float> &to, const std::vector<float> &values) {
      to.insert(to.end(), values.begin(), values.end());
    };
    append(result.positions, keys[i].positions);
    if (!result.normals.empty())
      append(result.normals, keys[i].normals);
  }
  result.keyTimes = std::move(times);
  return result;
}

void validateMesh(const Mesh &mesh, const std::string &name) {
  if (mesh.positions.size() % 3 != 0 || mesh.indices.size() % 3 != 0)
    throw Error(message::meshIncomplete(name), Place{name});
  if (mesh.indices.empty())
    throw Error(message::meshWithoutTriangles(name), Place{name});
  std::size_t vertices = mesh.vertexCount();
  if (vertices > 0xffffffffu || mesh.triangleCount() > 0x7fffffffu)
    throw Error(message::meshCountsTooLarge(name), Place{name});
  if (mesh.positions.size() != 3 * vertices * mesh.keyCount())
    throw Error(message::meshPositionCount(name, mesh.positions.size() / 3, mesh.keyCount()),
                Place{name});
  if (!mesh.normals.empty() && mesh.normals.size() != mesh.positions.size())
    throw Error(message::meshNormalCount(name, mesh.normals.size() / 3, mesh.positions.size() / 3),
                Place{name});
  if (!mesh.uvs.empty() && mesh.uvs.size() != 2 * vertices)
    throw Error(message::meshUvCount(name, mesh.uvs.size() / 2, vertices), Place{name});
  const char axes[] = "xyz";
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    float p = mesh.positions[i];
    if (!std::isfinite(p))
      throw Error(message::vertexNotFinite(name, axes[i % 3], i / 3, p), Place{name});
    if (std::fabs(p) > largestCoordinate)
      throw Error(message::vertexTooFar(name, axes[i % 3], i / 3, p, largestCoordinate),
                  Place{name});
  }
  for (std::size_t i = 0; i < mesh.normals.size(); ++i)
    if (!std::isfinite(mesh.normals[i]))
      throw Error(message::normalNotFinite(name, i / 3), Place{name});
  for (std::size_t i = 0; i < mesh.uvs.size(); ++i)
    if (!std::isfinite(mesh.uvs[i]))
      throw Error(message::uvNotFinite(name, i / 2), Place{name});
  for (const NamedAttribute &attribute : mesh.attributes)
    validateAttribute(mesh, attribute, name);
  for (std::size_t i = 0; i < mesh.indices.size(); ++i)
    if (mesh.indices[i] >= vertices)
      throw Error(message::meshIndexOutOfRange(name, i / 3, mesh.indices[i], vertices),
                  Place{name});
}

} // namespace rtsl::runtime
