//===- Material.h - a material of an MTL file as one of the library -------===//
#pragma once

#include "scenefile/gltf/Textures.h"
#include "scenefile/obj/Mtl.h"

namespace rtsl::scene::obj {

/// What an author would write for it; docs/scene-format.md says what becomes of each statement.
/// `size` is that of the model, for heights that are given without a unit. `colors`, those of the
/// vertices, are a factor of `Kd`. Statements that have no meaning here are warned of by name.
/// Throws WrongType, OutOfRange.
JsonValue materialOf(const Material &material, double size, gltf::VertexColors colors,
                     const gltf::Mention &mention, gltf::Modules &modules,
                     std::vector<Warning> &warnings);

/// Of triangles without a material: gray, or the colors of their vertices.
JsonValue defaultMaterial(const JsonValue &source, gltf::VertexColors colors,
                          gltf::Modules &modules);

} // namespace rtsl::scene::obj
