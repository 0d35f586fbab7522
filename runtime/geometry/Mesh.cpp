#include "runtime/geometry/Mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace rtsl::runtime {

void Mesh::apply(const Transform &transform) {
  const auto &c = transform.columns;
  for (std::size_t i = 0; i + 2 < positions.size(); i += 3) {
    double x = positions[i], y = positions[i + 1], z = positions[i + 2];
    for (int row = 0; row < 3; ++row)
      positions[i + row] = float(c[0][row] * x + c[1][row] * y + c[2][row] * z + c[3][row]);
  }
  // The cofactors are the inverse transpose times the determinant; its sign keeps normals on the
  // same side.
  double sign = transform.determinant() < 0 ? -1 : 1;
  double cofactors[3][3];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      cofactors[i][j] = sign * (c[i1][j1] * c[i2][j2] - c[i1][j2] * c[i2][j1]);
    }
  for (std::size_t i = 0; i + 2 < normals.size(); i += 3) {
    double x = normals[i], y = normals[i + 1], z = normals[i + 2], n[3];
    for (int row = 0; row < 3; ++row)
      n[row] = cofactors[0][row] * x + cofactors[1][row] * y + cofactors[2][row] * z;
    double length = std::hypot(n[0], n[1], n[2]);
    for (int row = 0; row < 3; ++row)
      normals[i + row] = length > 0 ? float(n[row] / length) : 0.0f;
  }
  if (sign < 0)
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
      std::swap(indices[i + 1], indices[i + 2]);
}

namespace {

/// Products of three coordinates, and Embree's arithmetic, stay well within the range of a float.
constexpr float largestCoordinate = 1e18f;

[[noreturn]] void throwBad(const std::string &name, const std::string &what) {
  throw Error(ErrorCode::BadMesh, fmt::format("mesh `{}` {}", name, what), Place{name});
}

} // namespace

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
      throwBad(names[i], fmt::format("has {} vertices, but the first key of its object, `{}`, has "
                                     "{}",
                                     key.vertexCount(), names[0], result.vertexCount()));
    if (key.indices != result.indices)
      throwBad(names[i],
               fmt::format("has other triangles than the first key of its object, `{}`", names[0]));
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
    throwBad(name, "has an incomplete vertex or triangle");
  if (mesh.indices.empty())
    throwBad(name, "has no triangles");
  std::size_t vertices = mesh.vertexCount();
  if (vertices > 0xffffffffu || mesh.triangleCount() > 0x7fffffffu)
    throwBad(name, "is too large: at most 2^32 vertices and 2^31 triangles");
  if (mesh.positions.size() != 3 * vertices * mesh.keyCount())
    throwBad(name, fmt::format("has {} positions of vertices for {} keys",
                               mesh.positions.size() / 3, mesh.keyCount()));
  if (!mesh.normals.empty() && mesh.normals.size() != mesh.positions.size())
    throwBad(name, fmt::format("has {} normals for {} vertices", mesh.normals.size() / 3,
                               mesh.positions.size() / 3));
  if (!mesh.uvs.empty() && mesh.uvs.size() != 2 * vertices)
    throwBad(name, fmt::format("has {} texture coordinates for {} vertices", mesh.uvs.size() / 2,
                               vertices));
  const char axes[] = "xyz";
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    float p = mesh.positions[i];
    if (!std::isfinite(p))
      throwBad(name, fmt::format("has a vertex that is not finite: {} of vertex {} is {}",
                                 axes[i % 3], i / 3, p));
    if (std::fabs(p) > largestCoordinate)
      throwBad(name,
               fmt::format("has a vertex too far out: {} of vertex {} is {:g}, more than {:g}",
                           axes[i % 3], i / 3, p, largestCoordinate));
  }
  for (std::size_t i = 0; i < mesh.normals.size(); ++i)
    if (!std::isfinite(mesh.normals[i]))
      throwBad(name, fmt::format("has a normal that is not finite at vertex {}", i / 3));
  for (std::size_t i = 0; i < mesh.uvs.size(); ++i)
    if (!std::isfinite(mesh.uvs[i]))
      throwBad(name,
               fmt::format("has a texture coordinate that is not finite at vertex {}", i / 2));
  for (std::size_t i = 0; i < mesh.indices.size(); ++i)
    if (mesh.indices[i] >= vertices)
      throwBad(name, fmt::format("has an index out of range: triangle {} uses vertex {} of {}",
                                 i / 3, mesh.indices[i], vertices));
}

} // namespace rtsl::runtime
