//===- Material.h - materials of a glTF file ------------------------------===//
#pragma once

#include "scenefile/gltf/Textures.h"

namespace rtsl::scene::gltf {

/// The object of a scene that is material number `index`: a Principled of the standard library,
/// wrapped for its normals and its holes; or an Emitter, if it is unlit. `colors` are those of the
/// meshes that have it.
JsonValue materialOf(const File &file, std::size_t index, VertexColors colors,
                     const Mention &mention, Modules &modules, std::vector<Warning> &warnings);

/// The material of primitives that have none. `source` is for its position.
JsonValue defaultMaterial(const JsonValue &source, VertexColors colors, Modules &modules);

/// An object of a class of std.materials, such as "Principled"; if there are vertex colors, of the
/// one that multiplies by them.
JsonValue materialObject(const JsonValue &source, const std::string &name, VertexColors colors,
                         Modules &modules);

} // namespace rtsl::scene::gltf
