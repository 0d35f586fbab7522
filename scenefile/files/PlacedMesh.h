//===- PlacedMesh.h - meshes of nodes in world space ----------------------===//
//
// A ray that enters an instance is transformed, and searches a tree of its own. A mesh that is in
// the scene once, and does not move, needs neither: its vertices are transformed when it is loaded,
// as those of meshes in `objects` are. This must not cost accuracy: far from the origin floats are
// too coarse for a small mesh, which then stays in its own space.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/geometry/Mesh.h"
#include "scenefile/SceneFile.h"

namespace rtsl::scene {

/// The transform by which the vertices of an object's mesh may be moved to world space; null: they
/// may not. That no other object has the mesh is left to the caller.
const runtime::Transform *placeOf(const GeometryDescription &geometry,
                                  const SceneDescription &scene);

/// Moves the mesh to world space, if it stays accurate there, and only its rounding changes.
/// Returns whether it did.
bool place(runtime::Mesh &mesh, const runtime::Transform &toWorld);

/// Are the vertices, rounded to floats in world space, off by at most four times as much as those
/// of the file are for that they are floats?
bool staysAccurate(const runtime::Mesh &mesh, const runtime::Transform &toWorld);

} // namespace rtsl::scene
