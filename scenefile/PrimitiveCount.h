//===- PrimitiveCount.h - `count` of an object ----------------------------===//
#pragma once

#include "scenefile/SceneFile.h"

namespace rtsl::scene {

/// The number of primitives that an object of the scene holds. Throws OutOfRange, UnknownName.
std::uint32_t primitivesOf(const GeometryDescription &geometry, const runtime::Scene &scene,
                           RtslRef primitive);

} // namespace rtsl::scene
