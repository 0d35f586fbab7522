//===- PlyFile.h - Stanford PLY files -------------------------------------===//
#pragma once

#include "runtime/geometry/Mesh.h"
#include "support/Error.h"

#include <optional>
#include <string>
#include <string_view>

namespace rtsl::runtime {

/// Reads the contents of nearly all PLY files of meshes: vertices with coordinates, normals and
/// texture coordinates as separate numbers, and faces of three or four corners; text or binary;
/// other elements and numbers are skipped, unless they are requested as attributes of vertices or
/// faces. Nothing if the file is of another kind or damaged: such files are left to the general
/// reader (MeshFile.cpp).
std::optional<Mesh> readPlainPly(std::string_view bytes, const MeshRequest &request = {});

/// Why the file at `path`, which consists of `bytes`, is not a valid PLY file; nothing if its
/// header is valid, all elements that the header declares are there, with numbers of the declared
/// types, and the corners of faces are vertices. The general reader must not read invalid files: it
/// reads zeros, does not terminate, or crashes.
std::optional<Message> findPlyDamage(std::string_view bytes, const std::string &path);

} // namespace rtsl::runtime
