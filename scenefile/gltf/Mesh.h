//===- Mesh.h - the triangles of a glTF file ------------------------------===//
#pragma once

#include "runtime/geometry/Mesh.h"
#include "scenefile/gltf/File.h"

namespace rtsl::scene::gltf {

/// `meshes.M.primitives.P`.
std::string partOfPrimitive(std::size_t mesh, std::size_t primitive);

/// The primitive that a part names. Throws UnknownName. `place` is that of the name.
const JsonValue &primitiveOf(const File &file, const std::string &part, const Place &place);

/// Whether it has triangles: points and lines are not seen.
bool hasTriangles(const JsonValue &primitive, const std::string &part);

/// How many morph targets a primitive has.
std::size_t targetCount(const JsonValue &primitive, const std::string &part);

/// Checks a primitive as far as it can be without the bytes of buffers.
void checkPrimitive(const File &file, const JsonValue &primitive, const std::string &part);

/// Throws BadBuffer for `COLOR_0` of another type than VEC3 and VEC4.
VertexColors vertexColorsOf(const File &file, const JsonValue &primitive, const std::string &part);

/// What of a primitive is left out, by name.
std::vector<Warning> warningsOf(const JsonValue &primitive, const std::string &part);

/// Reads a primitive, and of its other attributes those that are requested: `TEXCOORD_1` is `uv1`,
/// `COLOR_0` `color`, `TANGENT` `tangent`, and an author's own, such as `_WEAR`, `wear`. Texture
/// coordinates are turned from glTF's, which begin at the upper left corner of an image, to ours.
/// `COLOR_0` is clamped to [0, 1], as glTF demands.
/// `weights`: of its morph targets, whose positions and normals are added; empty: all are 0.
/// Throws BadMesh, BadBuffer.
runtime::Mesh readMesh(const File &file, const std::string &part,
                       const runtime::MeshRequest &request = {},
                       const std::vector<double> &weights = {});

} // namespace rtsl::scene::gltf
