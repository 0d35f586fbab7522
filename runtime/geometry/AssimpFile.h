//===- AssimpFile.h - meshes by assimp ------------------------------------===//
#pragma once

#include "runtime/geometry/Mesh.h"

#include <string>
#include <vector>

namespace rtsl::runtime {

/// Does assimp have a reader for files with this extension, such as ".glb"?
bool isReadByAssimp(const std::string &extension);

/// loadMesh for a file that can be read. Its attributes are `color`, `color1` and so on, `uv1` and
/// so on, and `tangent`, of those meshes of the file that have them; zeros in the others.
/// Throws BadMesh, OutOfMemory.
Mesh readByAssimp(const std::string &path, const MeshRequest &request = {});

/// The same by the names of the materials; with colors, if all meshes of the file have them.
std::vector<MeshGroup> readGroupsByAssimp(const std::string &path);

} // namespace rtsl::runtime
