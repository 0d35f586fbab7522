//===- PlyFile.h - Stanford PLY files -------------------------------------===//
#pragma once

#include "runtime/geometry/Mesh.h"

#include <optional>
#include <string>
#include <string_view>

namespace rtsl::runtime {

/// Reads the contents of nearly all PLY files of meshes: vertices with coordinates, normals and
/// texture coordinates as separate numbers, and faces of three or four corners; text or binary;
/// other elements and numbers are skipped, unless they are requested as attributes of vertices or
/// faces. Nothing if the file is of another kind or damaged: such
/// files are left to the general reader (MeshFile.cpp).
std::optional<Mesh> readPlainPly(std::string_view bytes, const MeshRequest &request = {});

/// Why the file cannot be a PLY file, for a message such as "is truncated: it ends in element 3 of
/// 50 of `face`". Empty if its header is valid, and all elements that this declares are there. The
/// general reader must not read other files: it reads zeros, never ends or crashes.
std::string findPlyDamage(std::string_view bytes);

} // namespace rtsl::runtime
