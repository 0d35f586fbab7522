//===- ObjFile.h - Wavefront OBJ files of the usual kind ------------------===//
#pragma once

#include "runtime/geometry/Mesh.h"

#include <optional>
#include <string_view>

namespace rtsl::runtime {

/// Reads what nearly all OBJ files consist of: vertices, normals, texture coordinates, and faces of
/// three or four corners that refer to what stands before them. Groups and materials make no
/// difference. Corners that are equal in all indices share a vertex. Nothing if the file has
/// anything else in it or is damaged: such files are left to the general reader (MeshFile.cpp),
/// which also says what is wrong with them. That one is ten times slower where files are small.
std::optional<Mesh> readPlainObj(std::string_view text);

} // namespace rtsl::runtime
