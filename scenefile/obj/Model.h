//===- Model.h - an OBJ file with its materials, as a glTF file -----------===//
//
// An OBJ file becomes what a glTF file with the same content would be: one node with one mesh,
// which has a primitive for each material. All that can be done with models follows. Its materials
// are written as those of the library that come closest, not as glTF's. So does a PLY file, which
// has no materials.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "scenefile/gltf/File.h"

#include <memory>
#include <string>

namespace rtsl::scene::obj {

/// Is it an OBJ or a PLY file, by its name?
bool isModel(const std::string &path);

/// Reads it, with the files of `mtllib`. One that is missing is a warning, and so is a material
/// that none of them has: its triangles are gray. Throws the errors of loadMesh and readMaterials.
std::unique_ptr<gltf::File> readModel(const std::string &path);

} // namespace rtsl::scene::obj
