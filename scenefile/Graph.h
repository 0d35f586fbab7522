//===- Graph.h - the nodes of a scene file --------------------------------===//
//
// A node is a geometry (a mesh or a primitive, with a material), or has children, other nodes; each
// may have a transform, which applies to all that is below. Nodes may be shared: a node is an
// instance of its geometry for each way from a root down to it. docs/scene-format.md has the keys.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "scenefile/SceneFile.h"
#include "support/ErrorCollector.h"

#include <functional>

namespace rtsl::scene {

/// Reads the geometry of the node `value`, except its transform.
using ReadGeometry = std::function<GeometryDescription(const JsonValue &value)>;

/// Reads `nodes`, and `root` or `roots`, of a scene: appends the geometries that a root leads to,
/// with their instances, to `scene.objects`, and sets `scene.roots`. Nodes that no root leads to
/// are noted in `scene.warnings`. Adds mistakes to `errors`.
void readGraph(const JsonValue &root, const ReadGeometry &readGeometry, SceneDescription &scene,
               ErrorCollector &errors);

} // namespace rtsl::scene
