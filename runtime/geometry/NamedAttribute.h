//===- NamedAttribute.h - numbers of a mesh that materials read by name ---===//
#pragma once

#include "runtime/geometry/Transform.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace rtsl::runtime {

/// A further set of texture coordinates, colors, tangents, or anything else that a mesh has for
/// each vertex or for each triangle. A material reads it as a scratch member of this name.
struct NamedAttribute {
  enum class Kind : std::uint8_t { Float, Int, UInt, Bool };
  /// How a transform of the mesh changes the numbers; in the order of RTSL_ATTRIBUTE_*. Points,
  /// vectors and normals have three components; a tangent has a fourth, the side of the bitangent.
  enum class Space : std::uint8_t { Numbers, Point, Vector, Normal, Tangent };

  std::string name;
  std::uint32_t components = 1;
  Kind kind = Kind::Float;  // of vertices: Float, because they are interpolated
  bool ofTriangles = false; // for each triangle; otherwise for each vertex
  Space space = Space::Numbers;
  bool isRgb = false;               // red, green, blue and perhaps alpha
  std::vector<std::uint32_t> words; // `components` for each vertex or triangle, as bits
};

/// An attribute of vertices from floats.
NamedAttribute floatAttribute(std::string name, std::uint32_t components,
                              const std::vector<float> &numbers);

/// The numbers of components that an attribute of this space may have: 0 is any.
std::uint32_t componentsOf(NamedAttribute::Space space);

/// The name in scene files: "vector".
const char *nameOf(NamedAttribute::Space space);

/// Transforms points, vectors, normals and tangents.
void apply(const Transform &transform, NamedAttribute &attribute);

/// Where the vertices and triangles of a mesh are in its file, for numbers that lie elsewhere.
struct FileOrder {
  bool isKnown = false;
  std::size_t vertexCount = 0, faceCount = 0; // of the file
  std::vector<std::uint32_t> vertices;        // of each vertex; empty: they are in the same order
  std::vector<std::uint32_t> faces;           // of each triangle; empty: the same
};

/// What to read of a file in addition to what every mesh has.
struct MeshRequest {
  std::vector<std::string> attributes; // those of these names that the file has
  bool keepsOrder = false;             // sets Mesh::order, if the reader can tell

  bool wants(const std::string &name) const;
};

} // namespace rtsl::runtime
