//===- Graph.h - the nodes of a scene file --------------------------------===//
//
// A node is a geometry (a mesh or a primitive, with a material), or a light, or has children, other
// nodes, and perhaps a selector among them; each may have a transform, an id and variables, which
// apply to all that is below. Nodes may be shared: a node is an instance of its geometry for each
// path from a root to it. docs/scene-format.md has the keys.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "scenefile/SceneFile.h"
#include "support/ErrorCollector.h"

#include <functional>

namespace rtsl::scene {

/// How to read the parts of a node that are no part of the graph.
struct NodeReaders {
  /// The geometry of the node `value`, except its transform and variables.
  std::function<GeometryDescription(const JsonValue &value)> geometry;
  /// A reference to an object. `what` begins messages.
  std::function<ReferenceDescription(const JsonValue &value, const std::string &what)> reference;
};

/// Reads `nodes`, and `root` or `roots`, of a scene: appends the geometries that a root leads to,
/// with their instances, to `scene.objects`, and lights to `scene.lights`, and sets `scene.roots`,
/// `scene.nodes`, `scene.selectors` and `scene.scopes`. Nodes that no root leads to are noted in
/// `scene.warnings`. Adds mistakes to `errors`.
void readGraph(const JsonValue &root, const NodeReaders &readers, SceneDescription &scene,
               ErrorCollector &errors);

/// `variables` of a node or the scene. Throws WrongType.
VariableDefinitions readVariables(const JsonValue &value);

/// Adds a scope below `above`.
const VariableScope *addScope(SceneDescription &scene, const VariableScope *above,
                              VariableDefinitions variables);

} // namespace rtsl::scene
