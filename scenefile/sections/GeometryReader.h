//===- GeometryReader.h - meshes and primitives of a scene file -----------===//
#pragma once

#include "scenefile/SceneFile.h"
#include "support/ErrorCollector.h"

namespace rtsl::scene {

/// The mesh or primitive of a node or of an element of `objects`, with its material, but without
/// transform and variables. `what` begins messages. Mistakes are added to `errors`.
GeometryDescription readGeometry(const JsonValue &value, const std::string &what,
                                 SceneDescription &scene, ErrorCollector &errors);

/// An element of `objects`: one instance. The vertices of a mesh are transformed, unless the
/// transform moves. Adds the scope of its variables to the scene. Throws WrongType.
GeometryDescription readObjectOfList(const JsonValue &value, SceneDescription &scene,
                                     ErrorCollector &errors);

} // namespace rtsl::scene
