//===- Mesh.h - triangle meshes and their files ---------------------------===//
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
  /// Rotates by `degrees` about `axis` (of any length but zero), counter-clockwise when the axis
  /// points at the viewer.
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

  /// Transforms the vertices; normals by the inverse transpose. A mirroring transform also reverses
  /// the triangles, so that their geometric normals stay on the same side.
  void apply(const Transform &transform);
};

/// Reads an OBJ, PLY or glTF file (or another format of the installed assimp). All meshes of the
/// file become one; polygons are triangulated, points and lines left out. Throws Error:
/// FileNotFound, FileUnreadable, UnsupportedFormat, BadMesh.
Mesh loadMesh(const std::string &path);

/// Throws BadMesh if the mesh is empty, has a coordinate that is not finite, an index out of range,
/// or a number of normals or uvs that differs from that of its vertices. `name` is for the message.
void validateMesh(const Mesh &mesh, const std::string &name);

} // namespace rtsl::runtime
