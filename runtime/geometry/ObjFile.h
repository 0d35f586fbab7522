//===- ObjFile.h - Wavefront OBJ files without rare features --------------===//
#pragma once

#include "runtime/geometry/Mesh.h"

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

namespace rtsl::runtime {

/// Parts of this size are read at the same time.
constexpr std::size_t bytesOfObjPart = 1 << 20;

/// Reads the contents of nearly all OBJ files: vertices, normals, texture coordinates, and faces of
/// three or four corners that refer to preceding lines. Groups and materials are ignored. Corners
/// that are equal in all indices share a vertex. The numbers after a position are the attribute
/// `color`. Nothing if the file contains anything else or is
/// damaged: such files are left to the general reader (MeshFile.cpp), which is ten times slower for
/// small files. Uses all cores; the result does not depend on how many
/// there are, nor on the size of parts.
std::optional<Mesh> readPlainObj(std::string_view text, const MeshRequest &request = {},
                                 std::size_t bytesOfPart = bytesOfObjPart);

/// The same with colors, by the names that follow `usemtl`.
std::optional<std::vector<MeshGroup>> readPlainObjGroups(std::string_view text,
                                                         std::size_t bytesOfPart = bytesOfObjPart);

} // namespace rtsl::runtime
