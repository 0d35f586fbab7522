//===- Mesh.h - triangle meshes and their files ---------------------------===//
#pragma once

#include "runtime/geometry/NamedAttribute.h"
#include "runtime/geometry/Transform.h"
#include "support/Error.h"

#include <cstdint>
#include <string>
#include <vector>

namespace rtsl::runtime {

/// An indexed triangle mesh. If it moves, positions and normals are those of all vertices at the
/// first key, then at the next; between keys they are interpolated linearly.
struct Mesh {
  std::vector<float> positions;       // 3 a vertex
  std::vector<float> normals;         // 3 a vertex, or empty
  std::vector<float> uvs;             // 2 a vertex, or empty
  std::vector<std::uint32_t> indices; // 3 a triangle
  std::vector<float> keyTimes;        // ascending, in [0, 1]; empty: it does not move
  std::vector<NamedAttribute> attributes;
  std::vector<std::string> otherAttributes; // names that its file has, too, and were not requested
  FileOrder order;                          // if it was requested

  std::size_t keyCount() const { return keyTimes.empty() ? 1 : keyTimes.size(); }
  std::size_t vertexCount() const { return positions.size() / 3 / keyCount(); }
  std::size_t triangleCount() const { return indices.size() / 3; }

  /// Transforms the vertices; normals by the inverse transpose. A mirroring transform also reverses
  /// the triangles, so that their geometric normals stay on the same side.
  ///
  /// Normals have length 1 afterwards, or all get the same factor: then what is interpolated
  /// between them has the direction that the transform gives to what was.
  enum class NormalLengths : std::uint8_t { One, Alike };
  void apply(const Transform &transform, NormalLengths lengths = NormalLengths::One);
};

/// Throws FileNotFound or FileUnreadable unless the file is there, can be read and is not empty.
void checkMeshFile(const std::string &path);

/// Reads an OBJ, PLY or glTF file (or another format of the installed assimp). All meshes of the
/// file become one; polygons are triangulated, points and lines left out. Throws Error:
/// FileNotFound, FileUnreadable, UnsupportedFormat, BadMesh.
Mesh loadMesh(const std::string &path, const MeshRequest &request = {});

/// The triangles of a file that have one material, by its name; empty: they have none.
struct MeshGroup {
  std::string material;
  Mesh mesh;
};

/// The same with colors, as a mesh for each material of an OBJ file, in the order of their names in
/// it.
std::vector<MeshGroup> loadMeshGroups(const std::string &path);

/// Adds an attribute whose values are in the order of the vertices, or of the faces, of the file
/// that the mesh is from; it replaces another one of its name. `file` is for messages. Throws
/// BadMesh, and NotSupported if the order is not known.
void addInFileOrder(Mesh &mesh, NamedAttribute attribute, const std::string &file);

/// Makes one moving mesh of several, which are its keys at these times: they must have the same
/// triangles and as many vertices. Texture coordinates and attributes are those of the first;
/// normals are kept if all have them. `names` are for messages. Throws BadMesh.
Mesh movingMesh(std::vector<Mesh> keys, std::vector<float> times,
                const std::vector<std::string> &names);

/// Throws BadMesh if the mesh is empty, has a coordinate that is not finite, an index out of range,
/// a number of normals or uvs that differs from that of its vertices, or a wrong attribute.
/// `name` is for the message.
void validateMesh(const Mesh &mesh, const std::string &name);

} // namespace rtsl::runtime
