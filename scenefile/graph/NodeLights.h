//===- NodeLights.h - lights in the scene graph ---------------------------===//
#pragma once

#include "scenefile/SceneFile.h"

namespace rtsl::scene {

/// Throws NotSupported unless lights of this class may be in a node: those of the standard library
/// whose members say which of them are points and which directions.
void requirePlaceable(const LocatedName &className);

/// The light of a node for an instance of it: its points and directions in world space. New values
/// are owned by `scene`. Throws NotSupported if the instance moves.
ObjectDescription placedLight(const ObjectDescription &light, const runtime::MovingTransform &way,
                              SceneDescription &scene);

} // namespace rtsl::scene
