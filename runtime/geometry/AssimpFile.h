//===- AssimpFile.h - meshes by assimp ------------------------------------===//
#pragma once

#include "runtime/geometry/Mesh.h"

#include <string>

namespace rtsl::runtime {

/// Does assimp have a reader for files with this extension, such as ".glb"?
bool isReadByAssimp(const std::string &extension);

/// loadMesh for a file that can be read. Throws BadMesh, OutOfMemory.
Mesh readByAssimp(const std::string &path);

} // namespace rtsl::runtime
