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

/// The elements that the header declares but the file does not contain, for a message such as "ends
/// in element 3 of 50 of `face`"; the general reader would read zeros instead. Empty if nothing is
/// missing, or the header is not understood.
std::string findMissingPlyElements(std::string_view bytes);

} // namespace rtsl::runtime
