//===- InvisibleObjects.h - primitives and cameras that show nothing ------===//
#pragma once

#include "runtime/scene/Scene.h"

#include <optional>
#include <string>

namespace rtsl::scene {

/// Why no ray can hit a primitive of the library, or why a camera of the library sees at most one
/// point, because of its values: "its `normal` is 0". Nothing for others, for classes of authors,
/// which say nothing about theirs, and for boxes without area, which are named for any class
/// (runtime/scene/Geometry.h).
std::optional<std::string> whyInvisible(const runtime::Scene &scene, RtslRef object);

} // namespace rtsl::scene
