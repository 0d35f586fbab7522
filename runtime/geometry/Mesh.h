//===- Mesh.h - triangle meshes and where they come from ------------------===//
#pragma once

#include "support/Error.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace rtsl::runtime {

/// An affine map: four columns of three, the last one the translation. x' = c0 x + c1 y + c2 z +
/// c3.
struct Transform {
  std::array<std::array<double, 3>, 4> columns{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}}};

  static Transform translate(double x, double y, double z);
  static Transform scale(double x, double y, double z);
  /// Turns by `degrees` round `axis` (of any length but zero), counter-clockwise when the axis
  /// points at the eye.
  static Transform rotate(const std::array<double, 3> &axis, double degrees);

  /// First `*this`, then `next`.
  Transform then(const Transform &next) const;
  double determinant() const;
};

/// An indexed triangle mesh.
struct Mesh {
  std::vector<float> positions;       // 3 a vertex
  std::vector<float> normals;         // 3 a vertex, or empty
  std::vector<float> uvs;             // 2 a vertex, or empty
  std::vector<std::uint32_t> indices; // 3 a triangle

  std::size_t vertexCount() const { return positions.size() / 3; }
  std::size_t triangleCount() const { return indices.size() / 3; }

  /// Moves the vertices; normals by the inverse transpose. A mirroring transform also turns the
  /// triangles round, so that their geometric normals stay on the side where they were.
  void apply(const Transform &transform);
};

/// Reads an OBJ, PLY or glTF file (or whatever else the installed assimp reads). All meshes of the
/// file become one; polygons are triangulated, points and lines left out. Throws Error:
/// FileNotFound, FileUnreadable, UnsupportedFormat, BadMesh.
Mesh loadMesh(const std::string &path);

/// Throws BadMesh if the mesh is empty, has a coordinate that is not finite, an index out of range,
/// or normals or uvs of another length than its vertices. `name` goes into the message.
void validateMesh(const Mesh &mesh, const std::string &name);

} // namespace rtsl::runtime
