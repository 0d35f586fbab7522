//===- InvisibleObjects.h - primitives and cameras that show nothing ------===//
#pragma once

#include "runtime/geometry/Mesh.h"
#include "runtime/scene/Scene.h"

#include <optional>
#include <string>

namespace rtsl::scene {

/// Why no ray can hit a primitive of the library, or why a camera of the library sees at most one
/// point, because of its values: "its `normal` is 0". Nothing for others, for classes of authors,
/// which say nothing about theirs, and for boxes without area, which are named for any class
/// (runtime/scene/Geometry.h).
std::optional<std::string> whyInvisible(const runtime::Scene &scene, RtslRef object);

/// The same of a mesh, at all of its keys.
std::optional<std::string> whyInvisible(const runtime::Mesh &mesh);

/// The library's primitives are seen as they are up to this distance from the origin
/// (tests/cli/render/scenes/test_sizes.py).
constexpr float farthest = 1e17f;

/// How far an instance of a primitive of the library reaches along an axis, if that is farther.
/// Nothing for classes of authors, and for boxes without an end.
std::optional<float> reachesTooFar(const runtime::Scene &scene, RtslRef primitive,
                                   std::uint32_t instance);

} // namespace rtsl::scene
